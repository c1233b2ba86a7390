//! Draws the cells of a k-d tree over boxes along a spiral, as an SVG on standard output:
//! `cargo run -p lancer-core --example draw_a_tree > docs/images/kd-tree.svg`

use lancer_core::accel::kd_tree::NodeKind;
use lancer_core::accel::{Aabb, KdSettings, KdTree, Primitives};
use lancer_core::geometry::{DVec3, Transform};
use std::error::Error;
use std::fmt::Write as _;
use std::io::Write;

/// Flat boxes, the further out the larger.
struct Spiral(u32);

impl Primitives for Spiral {
    fn count(&self) -> usize {
        self.0 as usize
    }

    fn bounds(&self, i: u32) -> Aabb {
        let turned = Transform::rotate(DVec3::Z, 24.0 * f64::from(i)).point(DVec3::X * f64::from(i * i));
        let (x, y, side) = (turned.x as f32, turned.y as f32, 2.0 + 1.5 * i as f32);
        Aabb { min: [x - side, y - side, 0.0], max: [x + side, y + side, 0.0] }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let spiral = Spiral(40);
    let tree = KdTree::build(&spiral, KdSettings { leaf: Some(2), depth: None })?;
    let mut svg = String::new();
    let [left, top, _] = tree.bounds().min;
    let [right, bottom, _] = tree.bounds().max;
    let (width, height) = (right - left, bottom - top);
    write!(svg, r#"<svg xmlns="http://www.w3.org/2000/svg" width="720" viewBox="{left:.0} {top:.0} "#)?;
    writeln!(svg, r#"{width:.0} {height:.0}" stroke="black" fill="none">"#)?;
    rectangle(&mut svg, &tree.bounds(), r##"fill="#fbfaf7""##)?;
    tree.visit_nodes(|_, node| {
        let style = match node.kind {
            NodeKind::Leaf([]) => r##"fill="#eef2f6" stroke-width="2""##.to_owned(),
            NodeKind::Leaf(_) => return,
            // The planes of the first levels are the heaviest.
            NodeKind::Inner { .. } => {
                let weight = 9.0 / f64::from(node.depth + 1) + 1.0;
                format!(r##"stroke="#7a8ba0" stroke-width="{weight:.1}""##)
            }
        };
        // Writing to a string cannot fail.
        let _ = rectangle(&mut svg, &node.bounds, &style);
    });
    for i in 0..spiral.0 {
        rectangle(&mut svg, &spiral.bounds(i), r##"fill="#c8452f" fill-opacity="0.75" stroke="none""##)?;
    }
    writeln!(svg, "</svg>")?;
    std::io::stdout().write_all(svg.as_bytes())?;
    Ok(())
}

fn rectangle(svg: &mut String, of: &Aabb, style: &str) -> std::fmt::Result {
    let ([left, top, _], [right, bottom, _]) = (of.min, of.max);
    let (width, height) = (right - left, bottom - top);
    writeln!(svg, r#"<rect x="{left:.1}" y="{top:.1}" width="{width:.1}" height="{height:.1}" {style}/>"#)
}
