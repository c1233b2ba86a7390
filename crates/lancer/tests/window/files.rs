//! Files: broken ones, dropped ones, changed ones.

use crate::sitting::{BALLS, shows_a_scene, sit};
use std::fs;

const BROKEN: &str = "format: 1\nobjects:\n  - {shape: spere}\n";

#[test]
fn a_broken_file_is_told_of_and_the_last_good_picture_stays() {
    let files = [("balls.yaml", BALLS), ("broken.yaml", BROKEN)];
    sit("broken", &["balls.yaml"], &files, |sitting| {
        let before = sitting.see("before")?;
        let drag = sitting.drag_file("broken.yaml")?;
        // A file over the window keeps it drawing.
        sitting.wait_for_change(&before)?;
        sitting.keep("over-the-window")?;
        drag.release()?;
        assert!(shows_a_scene(&sitting.see("told")?));
        sitting.wait_for_title("balls.yaml - Lancer")
    });
}

#[test]
fn a_broken_file_on_the_command_line_opens_a_window_that_says_so() {
    sit("broken-start", &["broken.yaml"], &[("broken.yaml", BROKEN)], |sitting| {
        sitting.command("whitted")?;
        sitting.wait_for_title("whitted - Lancer")?;
        assert!(shows_a_scene(&sitting.see("another-scene")?));
        Ok(())
    });
}

#[test]
fn a_dropped_file_is_opened_and_followed_when_it_changes() {
    sit("drop", &["shadows"], &[("my balls.yaml", BALLS)], |sitting| {
        sitting.wait_for_title("shadows - Lancer")?;
        sitting.drag_file("my balls.yaml")?.release()?;
        sitting.wait_for_title("my balls.yaml - Lancer")?;
        let balls = sitting.see("dropped")?;
        fs::write(sitting.path("my balls.yaml"), BALLS.replace("ambient: 0.2", "ambient: 0.5"))?;
        sitting.wait_for_change(&balls)?;
        sitting.see("brighter")?;
        Ok(())
    });
}
