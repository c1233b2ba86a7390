//! Files: broken ones, dropped ones, changed ones.

use crate::sitting::{shows_a_scene, sit, sit_in};
use std::fs;

const BALL: &str = "format: 1\nambient: 0.3\nlights: [{position: [4, 6, 4], intensity: 200}]\nobjects:\n  - {shape: sphere}\nrender: {width: 80, height: 60}\n";

const BROKEN: &str = "format: 1\nobjects:\n  - {shape: spere}\n";

#[test]
fn a_broken_file_is_told_of_and_the_last_good_picture_stays() {
    sit("broken", ["whitted"], |sitting| {
        let before = sitting.see("whitted")?;
        let broken = sitting.path("broken.yaml");
        fs::write(&broken, BROKEN)?;
        let drag = sitting.drag_file(&broken)?;
        sitting.see("over-the-window")?;
        drag.release()?;
        let after = sitting.see("told")?;
        assert!(shows_a_scene(&after) && before.difference(&after) < 0.5);
        sitting.wait_for_title("whitted - Lancer")
    });
}

#[test]
fn a_broken_file_on_the_command_line_opens_a_window_that_says_so() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("broken.yaml"), BROKEN).unwrap();
    sit_in(directory, "broken-start", ["broken.yaml"], |sitting| {
        sitting.command("whitted")?;
        sitting.wait_for_title("whitted - Lancer")?;
        assert!(shows_a_scene(&sitting.see("another-scene")?));
        Ok(())
    });
}

#[test]
fn a_dropped_file_is_opened_and_followed_when_it_changes() {
    sit("drop", ["whitted"], |sitting| {
        sitting.wait_for_title("whitted - Lancer")?;
        let file = sitting.path("my ball.yaml");
        fs::write(&file, BALL)?;
        sitting.drag_file(&file)?.release()?;
        sitting.wait_for_title("my ball.yaml - Lancer")?;
        let ball = sitting.see("dropped")?;
        fs::write(&file, BALL.replace("ambient: 0.3", "ambient: 0.9"))?;
        sitting.wait_for_change(&ball)?;
        sitting.see("brighter")?;
        Ok(())
    });
}
