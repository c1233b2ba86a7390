//! That every hierarchy is sound, whatever the boxes, and hides nothing.

use super::*;
use crate::testing::Random;

/// The hierarchy over triangles; that over objects is held to the same.
fn build(boxes: &[Aabb], quality: Quality) -> Bvh {
    for contents in CONTENTS {
        let bvh = Bvh::build(boxes, contents, quality).unwrap();
        assert_eq!(bvh.validate(boxes), Ok(()));
    }
    Bvh::build(boxes, Contents::Triangles, quality).unwrap()
}

const CONTENTS: [Contents; 2] = [Contents::Triangles, Contents::Objects];

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

/// Boxes that builders stumble over.
fn awkward(count: u32) -> Vec<(&'static str, Vec<Aabb>)> {
    let mut random = Random::new(5);
    let mut places = || (0..count).map(|_| (point(&mut random), point(&mut random))).collect::<Vec<_>>();
    let many = |aabb: &dyn Fn(u32) -> Aabb| (0..count).map(aabb).collect::<Vec<_>>();
    let cube = |center: f32, half: f32| Aabb { min: [center - half; 3], max: [center + half; 3] };
    let scattered = places();
    let at = |i: u32| scattered[i as usize];
    let needle = |i: u32| {
        let (a, mut b) = at(i);
        b[1] = a[1];
        spanning(a, b)
    };
    vec![
        ("identical", many(&|_| cube(1.0, 1.0))),
        ("nested", many(&|i| cube(0.0, 1.0 + i as f32))),
        ("nested in a corner", many(&|i| Aabb { min: [0.0; 3], max: [1.0 + i as f32; 3] })),
        (
            "coplanar",
            many(&|i| spanning([at(i).0[0], 0.5, at(i).0[2]], [at(i).0[0] + 0.01, 0.5, at(i).0[2]])),
        ),
        ("needles", many(&needle)),
        ("points", many(&|i| spanning(at(i).0, at(i).0))),
        ("one point", many(&|_| cube(0.0, 0.0))),
        ("on a line", many(&|i| cube(i as f32, 0.5))),
        ("ever further apart", many(&|i| cube(f32::from_bits(i << 12), 0.0))),
        ("a crowd and one far away", many(&|i| if i == 0 { cube(1e9, 1.0) } else { cube(at(i).0[0], 0.1) })),
        ("far from the origin", many(&|i| cube(1e6 + at(i).0[0], 0.1))),
        ("huge", many(&|i| cube(3e38 * at(i).0[0], 1e38 * at(i).1[0].abs()))),
        ("tiny", many(&|i| cube(1e-38 * at(i).0[0], 1e-44))),
        ("no numbers", many(&|i| if i % 3 == 0 { cube(f32::INFINITY, 1.0) } else { cube(0.0, 1.0) })),
    ]
}

/// Depth bounded, memory linear. Time is measured by the benchmarks, not asserted here.
#[test]
fn hundreds_of_thousands_of_awkward_boxes_build_in_linear_memory() {
    let n = 200_000;
    for ((name, boxes), quality) in
        awkward(n).into_iter().flat_map(|case| QUALITIES.map(|q| (case.clone(), q)))
    {
        let bvh = Bvh::build(&boxes, Contents::Triangles, quality).unwrap();
        assert_eq!(bvh.validate(&boxes), Ok(()), "{name}");
        let (nodes, depth) = (bvh.nodes().len(), bvh.depth());
        assert!(nodes <= n as usize / 5, "{name}: {nodes} nodes");
        assert!(depth <= Bvh::MAX_DEPTH, "{name}: depth {depth}");
    }
}

#[test]
fn scattered_boxes_take_fewer_than_18_bytes_each() {
    for quality in QUALITIES {
        let boxes = scattered(7, 200_000, 0.01);
        let bytes = build(&boxes, quality).bytes() as f64 / boxes.len() as f64;
        assert!(bytes < 18.0, "{bytes} bytes for a primitive");
    }
}

#[test]
fn the_hierarchy_does_not_depend_on_the_number_of_threads() {
    let boxes = scattered(3, 200_000, 0.01);
    for quality in QUALITIES {
        let shape = |threads: usize| {
            let build = || Bvh::build(&boxes, Contents::Triangles, quality).unwrap();
            let bvh = crate::render::with_threads(threads, build).unwrap();
            (bvh.nodes, bvh.order, bvh.depth)
        };
        let one = shape(1);
        assert!(one == shape(2) && one == shape(8), "{quality:?}");
    }
}

#[test]
fn a_child_remembers_what_it_was_made_of() {
    for count in 1..=MAX_LEAF as u32 {
        let first = Bvh::MAX_PRIMITIVES as u32 - count;
        let leaf = Child::leaf(first, count);
        assert!(leaf.is_leaf() && !leaf.is_none());
        assert_eq!((leaf.first(), leaf.count()), (first as usize, count as usize));
    }
    let inner = Child::inner(123_456_789);
    assert!(!inner.is_leaf() && !inner.is_none());
    assert_eq!(inner.node(), 123_456_789);
}

/// One box: a step into the root and one block.
#[test]
fn a_single_box_costs_a_step_and_a_block() {
    let boxes = [Aabb { min: [0.0; 3], max: [1.0, 2.0, 3.0] }];
    for (contents, block) in [(Contents::Triangles, cost::TRIANGLES), (Contents::Objects, cost::OBJECTS)] {
        let bvh = Bvh::build(&boxes, contents, Quality::High).unwrap();
        assert_eq!(bvh.expected_cost(), f64::from(cost::NODE_COST + cost::block_cost(block)));
    }
}

#[test]
fn an_object_has_a_leaf_to_itself_unless_boxes_are_alike() {
    let count = |boxes: &[Aabb]| {
        let bvh = Bvh::build(boxes, Contents::Objects, Quality::High).unwrap();
        let leaves = bvh.nodes().iter().flat_map(|node| (0..WIDTH).map(|place| node.child(place)));
        leaves.filter(|leaf| leaf.is_leaf() && !leaf.is_none()).map(Child::count).max()
    };
    assert_eq!(count(&scattered(5, 10_000, 0.01)), Some(1));
    assert_eq!(count(&[scattered(5, 1, 0.1)[0]; 8]), Some(8));
}

#[test]
fn eight_clusters_far_apart_become_the_children_of_the_root() {
    let corner = |i: usize, axis: usize| if i >> axis & 1 == 0 { 0.0 } else { 100.0 };
    let boxes = (0..4 * WIDTH).map(|i| {
        let min = std::array::from_fn(|axis| corner(i % WIDTH, axis) + (i / WIDTH) as f32);
        Aabb { min, max: min.map(|x| x + 1.0) }
    });
    let boxes = boxes.collect::<Vec<_>>();
    for quality in QUALITIES {
        let bvh = build(&boxes, quality);
        assert_eq!(bvh.nodes().len(), 1);
        assert!((0..WIDTH).all(|child| bvh.nodes()[0].child(child).count() == 4));
    }
}

#[test]
fn a_broken_hierarchy_is_found_out() {
    let boxes = scattered(1, 1000, 0.1);
    let sound = build(&boxes, Quality::High);
    let broken = |change: &dyn Fn(&mut Bvh)| {
        let mut bvh = sound.clone();
        change(&mut bvh);
        bvh.validate(&boxes).unwrap_err()
    };
    assert_eq!(
        broken(&|bvh| bvh.nodes[0].max[1][0] = bvh.nodes[0].min[1][0]),
        Defect::Bounds { node: 0, child: 0 }
    );
    let primitive = sound.order[0] as usize;
    assert_eq!(broken(&|bvh| bvh.order[0] = bvh.order[1]), Defect::Primitive { primitive });
    assert!(matches!(broken(&|bvh| bvh.depth -= 1), Defect::Depth { .. }));
    assert!(matches!(broken(&|bvh| bvh.nodes.push(WideNode::EMPTY)), Defect::Structure { .. }));
    assert_eq!(broken(&|bvh| bvh.nodes[0].children[0] = Child::NONE), Defect::Children { node: 0 });
}

/// No mesh has such boxes. They are lost, and nothing else is.
#[test]
fn boxes_that_are_no_numbers_do_no_harm() {
    let mut boxes = scattered(11, 100_000, 0.01);
    for broken in boxes.iter_mut().step_by(7) {
        *broken = Aabb { min: [f32::NAN; 3], max: [f32::NAN; 3] };
    }
    for quality in QUALITIES {
        let bvh = Bvh::build(&boxes, Contents::Triangles, quality).unwrap();
        assert_eq!(bvh.order().len(), boxes.len());
        assert!(bvh.depth() <= Bvh::MAX_DEPTH);
    }
}

#[test]
fn a_cancelled_build_makes_no_hierarchy() {
    let cancel = CancelToken::default();
    cancel.cancel();
    // Small, sorted into cells, and with all centres in one point.
    for boxes in [scattered(1, 10, 0.1), scattered(2, 50_000, 0.01), vec![scattered(3, 1, 0.1)[0]; 50_000]] {
        for quality in QUALITIES {
            let built = Bvh::build_with(&boxes, Contents::Objects, quality, &cancel);
            assert_eq!(built.map(drop), Err(BuildError::Cancelled));
        }
    }
}
