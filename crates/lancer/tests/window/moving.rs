//! The mouse in the picture.

use crate::sitting::{BALLS, shows_a_scene, sit};
use lancer_xvfb::Button;

#[test]
fn each_button_moves_the_view_and_home_goes_back() {
    sit("mouse", &["balls.yaml"], &[("balls.yaml", BALLS)], |sitting| {
        sitting.wait_for_title("balls.yaml - Lancer")?;
        let home = sitting.see("home")?;
        for (button, by, name) in [
            (Button::Left, (80, 30), "left"),
            (Button::Middle, (0, -60), "middle"),
            (Button::Right, (60, -20), "right"),
        ] {
            sitting.drag(button, by)?;
            let moved = sitting.see(name)?;
            assert!(shows_a_scene(&moved) && moved.difference(&home) > 0.1, "{name}");
            sitting.keys(&["Home"])?;
            sitting.wait_for_change(&moved)?;
            assert!(sitting.see("home-again")? == home, "{name}");
        }
        Ok(())
    });
}

#[test]
fn the_wheel_goes_nearer_and_back() {
    sit("wheel", &["balls.yaml"], &[("balls.yaml", BALLS)], |sitting| {
        let home = sitting.see("home")?;
        sitting.wheel(Button::WheelUp)?;
        let nearer = sitting.see("nearer")?;
        assert!(nearer.difference(&home) > 0.1);
        sitting.wheel(Button::WheelDown)?;
        assert!(sitting.see("back")?.difference(&nearer) > 0.1);
        Ok(())
    });
}
