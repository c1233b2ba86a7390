//! Vectors of three coordinates with many lanes each.
//!
//! Arrays are written out: the closures of `map` are not always inlined, and must be to be vectorised.

use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x16};

#[inline(always)]
pub(super) fn splat3<S: Simd, V: SimdFloat<S, Element = f32>>(simd: S, v: [f32; 3]) -> [V; 3] {
    [V::splat(simd, v[0]), V::splat(simd, v[1]), V::splat(simd, v[2])]
}

#[inline(always)]
pub(super) fn add<S: Simd, V: SimdFloat<S>>(a: [V; 3], b: [V; 3]) -> [V; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
pub(super) fn sub<S: Simd, V: SimdFloat<S>>(a: [V; 3], b: [V; 3]) -> [V; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Loads lanes by axis.
#[inline(always)]
pub(super) fn load3<S: Simd, V: SimdFloat<S, Element = f32>>(simd: S, v: &[V::Array; 3]) -> [V; 3] {
    [V::load_array_ref(simd, &v[0]), V::load_array_ref(simd, &v[1]), V::load_array_ref(simd, &v[2])]
}

/// The vector in a lane.
#[inline(always)]
pub(super) fn at<S: Simd>([x, y, z]: [f32x4<S>; 3], lane: usize) -> [f32; 3] {
    [x[lane], y[lane], z[lane]]
}

/// The largest component in size.
#[inline(always)]
pub(super) fn largest<S: Simd, V: SimdFloat<S>>([x, y, z]: [V; 3]) -> V {
    x.abs().max(y.abs()).max(z.abs())
}

/// Products may be fused with the sums: kernels do not depend on how they round, only on how much.
#[inline(always)]
pub(super) fn dot<S: Simd, V: SimdFloat<S>>(a: [V; 3], b: [V; 3]) -> V {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}

#[inline(always)]
pub(super) fn cross<S: Simd, V: SimdFloat<S>>(a: [V; 3], b: [V; 3]) -> [V; 3] {
    [a[1].mul_sub(b[2], a[2] * b[1]), a[2].mul_sub(b[0], a[0] * b[2]), a[0].mul_sub(b[1], a[1] * b[0])]
}

/// Four lanes from each of four.
#[inline(always)]
pub(super) fn joined<S: Simd>([a, b, c, d]: [f32x4<S>; 4]) -> f32x16<S> {
    a.combine(b).combine(c.combine(d))
}
