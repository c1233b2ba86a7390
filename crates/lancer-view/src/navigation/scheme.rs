//! Which button, and which two-finger movement, does what.

use crate::language::Phrase;
use serde::{Deserialize, Serialize};

/// A way to move the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gesture {
    /// In the plane of the picture.
    Pan,
    /// Along the viewing axis.
    Dolly,
    /// About the point of interest.
    Rotate,
}

/// A button of the mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    /// The left one, or a tap of one finger that moves on.
    Left,
    /// The middle one, mostly the wheel itself.
    Middle,
    /// The right one.
    Right,
}

/// The keys held while a button is pressed or a wheel turns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Modifiers {
    /// Shift.
    pub shift: bool,
    /// Control; on a Mac, command. Pinching a trackpad counts as scrolling with it.
    pub ctrl: bool,
    /// Alt, or option.
    pub alt: bool,
}

/// What the mouse does: a habit that each person brings along.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Scheme {
    /// A button a gesture: left moves across, middle moves along, right rotates.
    #[default]
    Assignment,
    /// The left button rotates, as in most programs that show a model.
    Orbit,
    /// For one button and two fingers.
    Trackpad,
}

impl Scheme {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Assignment, Self::Orbit, Self::Trackpad];

    /// What dragging with a button does.
    pub fn gesture(self, button: Button, held: Modifiers) -> Option<Gesture> {
        Some(match (self, button) {
            (Self::Assignment, Button::Left) => Gesture::Pan,
            (Self::Assignment, Button::Middle) => Gesture::Dolly,
            (Self::Assignment, Button::Right) => Gesture::Rotate,
            (_, Button::Left) => by_modifiers(held),
            (_, Button::Middle) => Gesture::Pan,
            (_, Button::Right) => Gesture::Dolly,
        })
    }

    /// What turning the wheel does, and scrolling with two fingers.
    pub fn wheel(self, held: Modifiers) -> Gesture {
        match self {
            Self::Assignment | Self::Orbit => Gesture::Dolly,
            Self::Trackpad => by_modifiers(held),
        }
    }

    /// What it is called.
    pub const fn name(self) -> Phrase {
        match self {
            Self::Assignment => Phrase::new("A button a movement", "Un bouton par mouvement"),
            Self::Orbit => Phrase::new("Orbit with the left button", "Orbite au bouton gauche"),
            Self::Trackpad => Phrase::new("Trackpad", "Pavé tactile"),
        }
    }

    /// What to do for each gesture, on one line.
    pub const fn hint(self) -> Phrase {
        match self {
            Self::Assignment => Phrase::new(
                "Left: move · Middle or wheel: nearer, farther · Right: rotate",
                "Gauche : déplacer · Milieu ou molette : approcher, éloigner · Droit : tourner",
            ),
            Self::Orbit => Phrase::new(
                "Left: rotate · Middle: move · Right or wheel: nearer, farther",
                "Gauche : tourner · Milieu : déplacer · Droit ou molette : approcher, éloigner",
            ),
            Self::Trackpad => Phrase::new(
                "Two fingers or drag: rotate · with Shift: move · pinch or with Ctrl: nearer, farther",
                "Deux doigts ou glisser : tourner · avec Maj : déplacer · pincer ou avec Ctrl : approcher, éloigner",
            ),
        }
    }
}

/// Rotate; with shift pan; with control dolly. Control wins, since a pinch comes with it whatever else is held.
fn by_modifiers(held: Modifiers) -> Gesture {
    match held {
        Modifiers { ctrl: true, .. } => Gesture::Dolly,
        Modifiers { shift: true, .. } => Gesture::Pan,
        _ => Gesture::Rotate,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: Modifiers = Modifiers { shift: false, ctrl: false, alt: false };
    const SHIFT: Modifiers = Modifiers { shift: true, ..NONE };
    const CTRL: Modifiers = Modifiers { ctrl: true, ..NONE };

    #[test]
    fn the_assignments_buttons_do_what_it_says_whatever_keys_are_held() {
        for held in [NONE, SHIFT, CTRL] {
            let gesture = |button| Scheme::Assignment.gesture(button, held);
            assert_eq!(gesture(Button::Left), Some(Gesture::Pan));
            assert_eq!(gesture(Button::Middle), Some(Gesture::Dolly));
            assert_eq!(gesture(Button::Right), Some(Gesture::Rotate));
            assert_eq!(Scheme::Assignment.wheel(held), Gesture::Dolly);
        }
    }

    #[test]
    fn every_scheme_reaches_every_gesture() {
        let everything = |scheme: Scheme| {
            let buttons = [Button::Left, Button::Middle, Button::Right];
            let drags = buttons.into_iter().flat_map(move |button| {
                [NONE, SHIFT, CTRL].into_iter().filter_map(move |held| scheme.gesture(button, held))
            });
            drags.collect::<Vec<_>>()
        };
        for scheme in Scheme::ALL {
            for gesture in [Gesture::Pan, Gesture::Dolly, Gesture::Rotate] {
                assert!(everything(scheme).contains(&gesture), "{scheme:?} lacks {gesture:?}");
            }
        }
    }

    #[test]
    fn a_trackpad_reaches_every_gesture_with_one_button_and_with_two_fingers() {
        for (held, gesture) in [(NONE, Gesture::Rotate), (SHIFT, Gesture::Pan), (CTRL, Gesture::Dolly)] {
            assert_eq!(Scheme::Trackpad.gesture(Button::Left, held), Some(gesture));
            assert_eq!(Scheme::Trackpad.wheel(held), gesture);
        }
    }
}
