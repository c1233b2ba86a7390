//! One start of the window, watched.

use crate::Failure;
use lancer_xvfb::{Area, Button, Display, Picture, Program, wait_for};
use std::path::Path;
use std::process::Command;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// More colours than an empty viewport has, with a word or a mark in it, and fewer than the coarsest picture.
const COLOURS_OF_A_SCENE: usize = 40;

/// The part of the watched pixels that must change to count: the marks of a pointer are less.
const CHANGE: f64 = 0.01;

/// The time between two looks at the display.
const LOOK: Duration = Duration::from_millis(2);

/// Pixels by which the mouse is moved, alternately there and back.
const STRIDE: i32 = 16;

/// Pictures are counted in a drag of this length, with a move every [`BETWEEN_MOVES`].
const DRAG: Duration = Duration::from_secs(3);

/// As often as a mouse tells of its moves to a screen of 60 Hz.
const BETWEEN_MOVES: Duration = Duration::from_millis(16);

/// Where the menus are, and in it the first two of them: they light up under the mouse, whatever else goes on.
const MENUS: Area = Area { x: 0, y: 0, width: 160, height: 24 };
const TWO_MENUS: [(i32, i32); 2] = [(20, 12), (60, 12)];

/// Where the program says what it is reading, and nothing once that is cancelled.
const STATUS: Area = Area { x: 0, y: 778, width: 300, height: 20 };

/// How long something has gone on when it is cancelled.
const BEFORE_CANCEL: Duration = Duration::from_millis(500);

/// How long the interface is asked for answers: while a large model is read and compiled, and then refined.
const ASKING: Duration = Duration::from_secs(5);

/// How long the program is left alone to see what it uses then.
const IDLE: Duration = Duration::from_secs(10);

pub(super) struct Session<'a> {
    display: &'a Display,
    program: Program<'a>,
    begun: Instant,
    watched: Area,
    /// Where the mouse is, and which way it goes next.
    at: (i32, i32),
    stride: i32,
}

/// In seconds since before the program was started.
pub(super) struct Started {
    pub(super) window: f64,
    pub(super) first_picture: f64,
    pub(super) sharp: f64,
}

impl<'a> Session<'a> {
    pub(super) fn start(
        display: &'a Display,
        lancer: &Path,
        scene: &str,
        watched: Area,
    ) -> Result<Self, Failure> {
        let begun = Instant::now();
        let program = Program::start(display, Command::new(lancer).arg(scene))?;
        Ok(Self { display, program, begun, watched, at: watched.centre(), stride: STRIDE })
    }

    /// Watches until the first picture is sharp.
    pub(super) fn watch_start(&mut self) -> Result<Started, Failure> {
        self.program.place_window(self.display.area())?;
        let window = self.begun.elapsed().as_secs_f64();
        let first_picture = wait_for("a picture of the scene", || {
            let seen = self.look()?.colours() > COLOURS_OF_A_SCENE;
            Ok(seen.then(|| self.begun.elapsed().as_secs_f64()))
        })?;
        let sharp = self.last_change()? - self.begun;
        Ok(Started { window, first_picture, sharp: sharp.as_secs_f64() })
    }

    /// Moves the mouse from menu to menu, from the moment when the window is seen. Returns the seconds from the
    /// program's start until the first of them lights up, and from each further move until its menu does.
    pub(super) fn watch_answers(&mut self) -> Result<(f64, Vec<f64>), Failure> {
        self.program.place_window(self.display.area())?;
        let look = || self.display.picture_of(MENUS);
        wait_for("the menus", || Ok((look()?.colours() > 2).then_some(())))?;
        let answer_to = |menu| -> Result<(Instant, Instant), Failure> {
            let before = look()?;
            let moved = Instant::now();
            self.display.warp_to(menu)?;
            Ok((moved, wait_for_change(look, &before)?))
        };
        let (_, ready) = answer_to(TWO_MENUS[0])?;
        let mut answers = Vec::new();
        for &menu in TWO_MENUS.iter().cycle().skip(1) {
            let (moved, answered) = answer_to(menu)?;
            answers.push((answered - moved).as_secs_f64());
            if ready.elapsed() > ASKING {
                break;
            }
        }
        Ok(((ready - self.begun).as_secs_f64(), answers))
    }

    /// Cancels the reading of the file that the program was started on. Returns the seconds from the key until the
    /// program has stopped speaking of it.
    pub(super) fn watch_cancelled_reading(&mut self) -> Result<f64, Failure> {
        self.program.place_window(self.display.area())?;
        let says_something =
            || -> Result<bool, Failure> { Ok(self.display.picture_of(STATUS)?.colours() > 2) };
        wait_for("what is being read", || Ok(says_something()?.then_some(())))?;
        sleep(BEFORE_CANCEL);
        if !says_something()? {
            return Err("the file was read before its reading was cancelled; take a larger one".into());
        }
        let asked = Instant::now();
        self.display.keys(&["Escape"])?;
        wait_for("the end of the reading", || Ok((!says_something()?).then(|| asked.elapsed().as_secs_f64())))
    }

    /// Renders, and cancels that. Returns the seconds from the key until the button to render is there again.
    pub(super) fn watch_cancelled_render(&mut self) -> Result<f64, Failure> {
        let (width, height) = self.display.size();
        let button = Area { x: width - 300, y: height - 70, width: 290, height: 34 };
        let look = || self.display.picture_of(button);
        self.display.move_to(self.at)?;
        let before = look()?;
        self.display.keys(&["F12"])?;
        wait_for_change(look, &before)?;
        sleep(BEFORE_CANCEL);
        if look()?.difference(&before) <= CHANGE {
            return Err("the render was done before it was cancelled; take one that takes longer".into());
        }
        let asked = Instant::now();
        self.display.keys(&["Escape"])?;
        wait_for("the end of the render", || {
            Ok((look()?.difference(&before) <= CHANGE).then(|| asked.elapsed().as_secs_f64()))
        })
    }

    /// Moves the mouse once, the left button held, and lets it go. Returns the seconds from the move until the
    /// picture changes, and from letting go until it does for the last time.
    pub(super) fn watch_move(&mut self) -> Result<(f64, f64), Failure> {
        self.display.move_to(self.at)?;
        self.display.press(Button::Left)?;
        self.last_change()?;
        let before = self.look()?;
        let moved = self.move_on()?;
        let change = wait_for_change(|| self.look(), &before)? - moved;
        self.display.release(Button::Left)?;
        let released = Instant::now();
        let refinement = self.last_change()? - released;
        Ok((change.as_secs_f64(), refinement.as_secs_f64()))
    }

    /// Moves the mouse on and on, the left button held. Returns the seconds between the pictures that are seen.
    pub(super) fn watch_drag(&mut self) -> Result<Vec<f64>, Failure> {
        self.display.press(Button::Left)?;
        let mut before = self.look()?;
        let begun = Instant::now();
        let (mut moved, mut seen) = (begun, None::<Instant>);
        let mut gaps = Vec::new();
        while begun.elapsed() < DRAG {
            if moved.elapsed() >= BETWEEN_MOVES {
                moved = self.move_on()?;
            }
            sleep(LOOK);
            let now = self.look()?;
            if now.difference(&before) > CHANGE {
                before = now;
                let now = Instant::now();
                gaps.extend(seen.replace(now).map(|seen| (now - seen).as_secs_f64()));
            }
        }
        self.display.release(Button::Left)?;
        self.program.settle()?;
        Ok(gaps)
    }

    /// Leaves the program alone, and returns how much of a processor it uses.
    pub(super) fn watch_idleness(&mut self) -> Result<f64, Failure> {
        self.program.settle()?;
        let before = self.program.processor_seconds()?;
        sleep(IDLE);
        Ok((self.program.processor_seconds()? - before) / IDLE.as_secs_f64())
    }

    fn look(&self) -> Result<Picture, Failure> {
        self.display.picture_of(self.watched)
    }

    /// Moves the mouse by one stride, and returns when.
    fn move_on(&mut self) -> Result<Instant, Failure> {
        self.at.0 += self.stride;
        if !within(self.watched, self.at.0 + self.stride) {
            self.stride = -self.stride;
        }
        let moved = Instant::now();
        self.display.warp_to(self.at)?;
        Ok(moved)
    }

    /// Watches until the program rests, and returns when the picture changed last; now, if it does not.
    fn last_change(&mut self) -> Result<Instant, Failure> {
        /// Longer than any pause between two passes of a refinement.
        const REST: Duration = Duration::from_millis(600);
        let mut before = self.look()?;
        let mut changed = Instant::now();
        let mut awake = changed;
        let first = changed;
        wait_for("the picture to stay", || {
            sleep(LOOK);
            let now = self.look()?;
            if now != before {
                changed = Instant::now();
                before = now;
            }
            if !self.program.is_asleep()? {
                awake = Instant::now();
            }
            Ok((changed.max(awake).elapsed() > REST).then_some(()))
        })?;
        Ok(if changed == first { first } else { changed })
    }
}

fn within(area: Area, x: i32) -> bool {
    (i32::from(area.x)..i32::from(area.x + area.width)).contains(&x)
}

fn wait_for_change(
    look: impl Fn() -> Result<Picture, Failure>,
    before: &Picture,
) -> Result<Instant, Failure> {
    wait_for("the picture to change", || {
        sleep(LOOK);
        Ok((look()?.difference(before) > CHANGE).then(Instant::now))
    })
}
