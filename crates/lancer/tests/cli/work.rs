//! The flags that decide how the work is done, which no byte of the picture may show.

use crate::sandbox::Sandbox;
use lancer_core::simd::InstructionSet;

const FLAGS: &str = "--samples 2 --ao 8 --depth 4";

/// The same picture made in another way.
fn assert_changes_nothing(way: &str) {
    let sandbox = Sandbox::new();
    assert!(sandbox.bytes(FLAGS) == sandbox.bytes(&format!("{FLAGS} {way}")), "{way} changes the picture");
}

#[test]
fn the_picture_does_not_depend_on_the_number_of_threads() {
    for threads in [1, 2, 8] {
        assert_changes_nothing(&format!("--threads {threads}"));
    }
}

#[test]
fn the_picture_does_not_depend_on_the_tile_size() {
    for size in [1, 5, 65_535] {
        assert_changes_nothing(&format!("--tile-size {size}"));
    }
}

#[test]
fn the_picture_does_not_depend_on_the_accelerator_or_its_bounds() {
    for way in [
        "--accel brute-force",
        "--accel bvh",
        "--accel kd-tree",
        "--kd-leaf 1",
        "--kd-depth 0",
        "--kd-depth 64",
    ] {
        assert_changes_nothing(way);
    }
}

#[test]
fn threads_and_accelerator_are_the_ones_asked_for() {
    let sandbox = Sandbox::new();
    let told = sandbox.json("render scene.yaml --threads 3 --accel brute-force --json");
    assert_eq!(told["threads"], 3);
    assert_eq!(told["accelerator"], "brute-force");
    let told = sandbox.json("render scene.yaml --json");
    let cores = std::thread::available_parallelism().unwrap().get();
    assert_eq!(told["threads"], cores);
    assert_eq!(told["accelerator"], "bvh");
    let told = sandbox.json("render scene.yaml --kd-leaf 4 --json");
    assert_eq!(told["accelerator"], "kd-tree");
}

#[test]
fn the_picture_does_not_depend_on_the_instruction_set() {
    let available = InstructionSet::ALL.into_iter().filter(|set| set.is_available());
    for set in available {
        assert_changes_nothing(&format!("--instructions {}", set.name()));
    }
}

#[test]
fn kd_leaf_and_kd_depth_bound_the_tree() {
    let sandbox = Sandbox::new();
    sandbox.write("grid.obj", grid(40));
    let nodes = |flags: &str| {
        let told = sandbox.json(&format!("render grid.obj --width 4 --height 4 --json {flags}"));
        (told["tree_nodes"].as_u64().unwrap(), told["tree_depth"].as_u64().unwrap())
    };
    let (free, _) = nodes("--accel kd-tree");
    let (large_leaves, _) = nodes("--kd-leaf 1000");
    assert!(large_leaves < free, "{large_leaves} nodes with large leaves, {free} without");
    let (_, depth) = nodes("--kd-depth 3");
    assert!(depth <= 3);
    // The tree of the only object, and the tree of its triangles: a root each.
    assert_eq!(nodes("--kd-depth 0"), (2, 0));
}

/// A square of n x n cells, two triangles each, with bumps.
fn grid(n: usize) -> String {
    let mut obj = String::new();
    for z in 0..=n {
        for x in 0..=n {
            obj += &format!("v {x} {} {z}\n", (x * z) % 3);
        }
    }
    let vertex = |x: usize, z: usize| z * (n + 1) + x + 1;
    for z in 0..n {
        for x in 0..n {
            let [a, b, c, d] = [vertex(x, z), vertex(x, z + 1), vertex(x + 1, z + 1), vertex(x + 1, z)];
            obj += &format!("f {a} {b} {c}\nf {a} {c} {d}\n");
        }
    }
    obj
}
