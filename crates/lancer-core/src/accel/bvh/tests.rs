//! That every hierarchy is sound, whatever the boxes, and hides nothing.

use super::*;
use crate::testing::Random;

fn build(boxes: &[Aabb], quality: Quality) -> Bvh {
    let bvh = Bvh::build(boxes, quality).unwrap();
    assert_eq!(bvh.validate(boxes), Ok(()));
    bvh
}

const QUALITIES: [Quality; 2] = [Quality::High, Quality::Fast];

fn point(random: &mut Random) -> [f32; 3] {
    random.point(1.0).as_vec3().to_array()
}

fn spanning(a: [f32; 3], b: [f32; 3]) -> Aabb {
    Aabb { min: a, max: a }.union(&Aabb { min: b, max: b })
}

/// Boxes with sides of up to `size`, anywhere.
fn scattered(seed: u32, count: usize, size: f32) -> Vec<Aabb> {
    let mut random = Random::new(seed);
    let mut one = || {
        let (a, b) = (point(&mut random), point(&mut random));
        spanning(a, std::array::from_fn(|axis| a[axis] + size * b[axis]))
    };
    (0..count).map(|_| one()).collect()
}

fn meet(a: &Aabb, b: &Aabb) -> bool {
    a.intersection(b).is_some()
}

/// The primitives whose boxes meet `query`, by the hierarchy.
fn overlaps(bvh: &Bvh, boxes: &[Aabb], query: &Aabb) -> Vec<u32> {
    let (mut found, mut pending) = (Vec::new(), vec![0]);
    while let Some(node) = pending.pop() {
        let node: &WideNode = &bvh.nodes()[node];
        for child in (0..WIDTH).filter(|&child| meet(&node.bounds(child), query)) {
            let what = node.child(child);
            if what.is_leaf() {
                let leaf = &bvh.order()[what.first()..][..what.count()];
                found.extend(leaf.iter().filter(|&&primitive| meet(&boxes[primitive as usize], query)));
            } else {
                pending.push(what.node());
            }
        }
    }
    found.sort_unstable();
    found
}

#[test]
fn the_hierarchy_hides_no_box_that_brute_force_finds() {
    for (seed, quality) in (0..8).flat_map(|seed| QUALITIES.map(|quality| (seed, quality))) {
        let boxes = scattered(seed, 700, [0.0, 0.01, 0.1, 1.0][seed as usize % 4]);
        let bvh = build(&boxes, quality);
        for query in scattered(100 + seed, 500, 0.2) {
            let brute = (0..700).filter(|&primitive| meet(&boxes[primitive as usize], &query));
            assert_eq!(overlaps(&bvh, &boxes, &query), brute.collect::<Vec<_>>());
        }
    }
}

#[test]
fn any_number_of_boxes_makes_a_sound_hierarchy() {
    for (count, quality) in (0..70).chain([1000]).flat_map(|n| QUALITIES.map(|quality| (n, quality))) {
        let bvh = build(&scattered(count as u32, count, 0.1), quality);
        assert_eq!(bvh.order().len(), count);
        assert_eq!(build(&vec![Aabb { min: [1.0; 3], max: [2.0; 3] }; count], quality).order().len(), count);
    }
}

#[test]
fn an_empty_hierarchy_has_a_root_without_children() {
    for quality in QUALITIES {
        assert_eq!(build(&[], quality).nodes(), [WideNode::EMPTY]);
    }
}
