//! Cubic Bézier curves, as much of them as lathed and patched shapes need.

/// The shares of the four control points in the curve's point at `t`. At the ends they are exactly 0 and 1, so
/// that curves that share an end meet there bit for bit.
pub(super) fn weights(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

/// The shares of the four control points in the curve's derivative by `t`.
pub(super) fn slopes(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t]
}
