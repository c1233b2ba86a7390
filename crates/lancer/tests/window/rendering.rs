//! Pictures at the chosen size.

use crate::sitting::{BALLS, shows_a_scene, sit};
use std::fs;

#[test]
fn a_saved_render_has_the_bytes_of_lancer_render() {
    sit("render", &["balls.yaml"], &[("balls.yaml", BALLS)], |sitting| {
        sitting.wait_for_title("balls.yaml - Lancer")?;
        let live = sitting.see("live")?;
        sitting.keys(&["F12"])?;
        sitting.wait_for_change(&live)?;
        assert!(shows_a_scene(&sitting.see("rendered")?));
        sitting.command("Save picture")?;
        sitting.see("asked-for-a-name")?;
        let saved = sitting.path("saved.png");
        sitting.enter(&saved.to_string_lossy())?;
        sitting.see("saved")?;
        sitting.lancer("render balls.yaml -o rendered.png");
        assert!(fs::read(saved)? == fs::read(sitting.path("rendered.png"))?);
        Ok(())
    });
}

#[test]
fn a_long_render_is_cancelled_and_the_view_is_back() {
    // Fifty times as many pixels as the view has: minutes.
    let long = BALLS.replace("width: 160, height: 120", "width: 4000, height: 3000");
    sit("cancel", &["long.yaml"], &[("long.yaml", &long)], |sitting| {
        sitting.wait_for_title("long.yaml - Lancer")?;
        let live = sitting.see("live")?;
        sitting.keys(&["F12"])?;
        sitting.wait_for_change(&live)?;
        sitting.keep("rendering")?;
        sitting.keys(&["Escape"])?;
        assert!(sitting.see("cancelled")? == live);
        Ok(())
    });
}

#[test]
fn a_copied_picture_is_pasted_as_the_pixels_that_lancer_render_makes() {
    sit("copy", &["balls.yaml"], &[("balls.yaml", BALLS)], |sitting| {
        sitting.wait_for_title("balls.yaml - Lancer")?;
        let live = sitting.see("live")?;
        assert_eq!(sitting.clipboard("image/png")?, None);
        sitting.keys(&["F12"])?;
        sitting.wait_for_change(&live)?;
        sitting.see("rendered")?;
        sitting.command("Copy picture")?;
        sitting.see("copied")?;
        let pasted = sitting.clipboard("image/png")?.expect("a picture is on the clipboard");
        sitting.lancer("render balls.yaml -o rendered.png");
        let pixels = |png: &[u8]| image::load_from_memory(png).map(|image| image.to_rgb8());
        assert!(pixels(&pasted)? == pixels(&fs::read(sitting.path("rendered.png"))?)?);
        Ok(())
    });
}
