//! Nodes that are not drawn.

use super::*;

fn ball(name: &str, x: f64) -> Node {
    Node::shape(name, Shape::Sphere).with_transform(Transform::translate(DVec3::X * x))
}

/// The objects' nodes by name.
fn drawn(scene: &Scene) -> Vec<&str> {
    let world = compile(scene);
    world.objects().iter().map(|object| scene.node(object.node()).name.as_str()).collect()
}

#[test]
fn neither_a_hidden_node_nor_anything_below_it_is_drawn() {
    let mut scene = Scene::new("hidden");
    scene.add(ball("kept", 0.0));
    let group = scene.add(Node { hidden: true, ..ball("hidden", 10.0) });
    let child = scene.add_child(group, ball("child", 10.0));
    scene.add_child(child, ball("grandchild", 10.0));
    scene.add(ball("last", -10.0));
    assert_eq!(drawn(&scene), ["kept", "last"]);
    assert!(compile(&scene).bounds().max.x < 2.0);
    scene.node_mut(group).hidden = false;
    assert_eq!(drawn(&scene), ["kept", "hidden", "child", "grandchild", "last"]);
}

#[test]
fn a_subtree_that_is_used_twice_is_hidden_where_its_user_is() {
    let mut scene = Scene::new("shared");
    let leaf = scene.insert(ball("leaf", 0.0));
    scene.add(Node { hidden: true, ..Node::group("hidden", [leaf, leaf]) });
    scene.add(Node::group("shown", [leaf]));
    assert_eq!(drawn(&scene), ["leaf"]);
    scene.node_mut(leaf).hidden = true;
    assert_eq!(compile_error(&scene), CompileError::NothingToDraw);
}

#[test]
fn a_scene_of_hidden_nodes_draws_nothing() {
    let mut scene = crowd(1);
    for root in scene.roots().to_vec() {
        scene.node_mut(root).hidden = true;
    }
    assert_eq!(compile_error(&scene), CompileError::NothingToDraw);
}

#[test]
fn the_transform_of_a_hidden_node_may_be_singular_but_its_references_may_not_dangle() {
    let mut scene = Scene::new("unfinished");
    scene.add(ball("kept", 0.0));
    let flat = Transform::scale(DVec3::new(1.0, 0.0, 1.0));
    let hidden = scene.add(Node { hidden: true, transform: flat, ..ball("flat", 0.0) });
    assert_eq!(drawn(&scene), ["kept"]);
    scene.node_mut(hidden).children = vec![hidden];
    assert_eq!(compile_error(&scene), CompileError::Cycle { node: "`flat`".into() });
}
