//! How it begins and ends.

use crate::sitting::{BALLS, shows_a_scene, sit};

#[test]
fn without_arguments_the_default_scene_is_shown_and_ctrl_q_quits() {
    sit("start", &[], &[], |sitting| {
        sitting.wait_for_title("whitted - Lancer")?;
        assert!(shows_a_scene(&sitting.see("default-scene")?));
        sitting.keys(&["ctrl+q"])?;
        assert!(sitting.end()?.success());
        Ok(())
    });
}

#[test]
fn the_cross_in_the_corner_closes() {
    sit("close", &["shadows"], &[], |sitting| {
        sitting.wait_for_title("shadows - Lancer")?;
        sitting.close()?;
        assert!(sitting.end()?.success());
        Ok(())
    });
}

#[test]
fn a_scene_is_chosen_by_its_name() {
    sit("choose", &["whitted"], &[], |sitting| {
        sitting.wait_for_title("whitted - Lancer")?;
        let whitted = sitting.see("whitted")?;
        sitting.command("mirrors")?;
        sitting.wait_for_title("mirrors - Lancer")?;
        let mirrors = sitting.see("mirrors")?;
        assert!(shows_a_scene(&mirrors) && mirrors.difference(&whitted) > 0.5);
        Ok(())
    });
}

#[test]
fn themes_and_languages_change_the_panels_and_no_pixel_of_the_scene() {
    sit("themes", &["balls.yaml"], &[("balls.yaml", BALLS)], |sitting| {
        let before = sitting.see("english")?;
        for command in ["Light theme", "Francais", "sombre", "English"] {
            sitting.command(command)?;
            assert!(sitting.see(&command.to_lowercase().replace(' ', "-"))? == before, "{command}");
        }
        Ok(())
    });
}
