//! What the picture is to be, set by mouse and keyboard.

use crate::sitting::{BALLS, sit};

#[test]
fn parameters_are_clicked_and_typed_and_undone() {
    sit("parameters", &["balls.yaml"], &[("balls.yaml", BALLS)], |sitting| {
        sitting.wait_for_title("balls.yaml - Lancer")?;
        let before = sitting.see("before")?;
        let mut controls = sitting.controls("balls.yaml")?;

        sitting.click(controls.place("Shadows")?)?;
        sitting.wait_for_change(&before)?;
        let without_shadows = sitting.see("without-shadows")?;

        sitting.click(controls.place("Exposure")?)?;
        sitting.enter("1.5")?;
        sitting.wait_for_change(&without_shadows)?;
        let brighter = sitting.see("brighter")?;
        assert!(brighter.difference(&without_shadows) > 0.5);

        sitting.keys(&["ctrl+z"])?;
        sitting.wait_for_change(&brighter)?;
        assert!(sitting.see("exposure-undone")? == without_shadows);
        sitting.keys(&["ctrl+z"])?;
        sitting.wait_for_change(&without_shadows)?;
        assert!(sitting.see("all-undone")? == before);
        Ok(())
    });
}
