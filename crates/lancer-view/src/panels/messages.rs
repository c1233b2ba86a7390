//! What the window tells: short messages that pass, errors that stay, and the faults of a file with their lines.

use crate::{Action, Language, Phrase, Source};
use eframe::egui::accesskit::{Live, Role};
use eframe::egui::{
    Align2, Area, Button, Color32, Context, Frame, Id, Label, Margin, Order, Rect, RichText, ScrollArea,
    Stroke, TextStyle, Ui, UiKind, vec2,
};
use lancer_io::diagnostics::Diagnostic;
use std::time::Duration;

/// How much a message matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// Something went as it should.
    Info,
    /// Something is odd.
    Warning,
    /// Something was not done.
    Error,
}

impl Severity {
    /// How long a message is shown; none for as long as it is not dismissed. Short enough not to be in the way, long
    /// enough to be read twice. Untuned.
    const fn seconds(self) -> Option<f64> {
        match self {
            Self::Info => Some(4.0),
            Self::Warning => Some(10.0),
            Self::Error => None,
        }
    }

    fn color(self, ui: &Ui) -> Color32 {
        match self {
            Self::Info => ui.visuals().hyperlink_color,
            Self::Warning => ui.visuals().warn_fg_color,
            Self::Error => ui.visuals().error_fg_color,
        }
    }
}

#[derive(Clone, Debug)]
struct Message {
    id: u64,
    severity: Severity,
    text: String,
    /// How often it was said in a row.
    times: u32,
    /// Seconds for which it has been seen.
    age: f64,
}

/// The messages that are shown.
#[derive(Clone, Debug, Default)]
pub struct Messages {
    list: Vec<Message>,
    next_id: u64,
}

/// Messages that are shown at once; older ones that would pass anyway make room.
const MOST: usize = 5;

const WIDTH: f32 = 360.0;

const DISMISS: Phrase = Phrase::new("Dismiss", "Fermer");

impl Messages {
    /// Says something. What is said again at once is counted and not repeated.
    pub fn say(&mut self, severity: Severity, text: impl Into<String>) {
        let text = text.into();
        if let Some(last) = self.list.last_mut()
            && last.severity == severity
            && last.text == text
        {
            (last.times, last.age) = (last.times + 1, 0.0);
            return;
        }
        if self.list.len() >= MOST
            && let Some(oldest) = self.list.iter().position(|message| message.severity.seconds().is_some())
        {
            self.list.remove(oldest);
        }
        self.list.push(Message { id: self.next_id, severity, text, times: 1, age: 0.0 });
        self.next_id += 1;
    }

    /// Says that something went well.
    pub fn info(&mut self, text: impl Into<String>) {
        self.say(Severity::Info, text);
    }

    /// Says that something is odd.
    pub fn warning(&mut self, text: impl Into<String>) {
        self.say(Severity::Warning, text);
    }

    /// Says that something was not done, and why.
    pub fn error(&mut self, text: impl Into<String>) {
        self.say(Severity::Error, text);
    }

    /// Draws the messages over a corner of `view`, the newest lowest.
    pub fn show(&mut self, ctx: &Context, view: Rect, language: Language) {
        if self.list.is_empty() {
            return;
        }
        let mut dismissed = None;
        let area = Area::new(Id::unique("messages")).order(Order::Foreground).kind(UiKind::Popup);
        let area = area.pivot(Align2::RIGHT_BOTTOM).fixed_pos(view.right_bottom() - vec2(12.0, 12.0));
        let area = area.show(ctx, |ui| {
            ui.set_width(WIDTH.min(view.width() - 24.0));
            for message in &self.list {
                if message.show(ui, language) {
                    dismissed = Some(message.id);
                }
            }
        });
        self.list.retain(|message| Some(message.id) != dismissed);
        // Nobody's message passes while it is being read.
        if !area.response.contains_pointer() {
            self.pass(ctx.input(|input| f64::from(input.stable_dt)));
        }
        if let Some(left) = self.time_left() {
            ctx.request_repaint_after(left);
        }
    }

    /// Lets time pass.
    fn pass(&mut self, seconds: f64) {
        for message in &mut self.list {
            message.age += seconds;
        }
        self.list.retain(|message| message.severity.seconds().is_none_or(|most| message.age < most));
    }

    /// Until the next message passes.
    fn time_left(&self) -> Option<Duration> {
        let left = |message: &Message| Some(message.severity.seconds()? - message.age);
        self.list
            .iter()
            .filter_map(left)
            .min_by(f64::total_cmp)
            .map(|left| Duration::from_secs_f64(left.max(0.0)))
    }
}

impl Message {
    /// Draws it. Returns whether it is dismissed.
    fn show(&self, ui: &mut Ui, language: Language) -> bool {
        let color = self.severity.color(ui);
        Frame::popup(ui.style())
            .stroke(Stroke::new(1.0, color))
            .inner_margin(Margin::symmetric(12, 8))
            .show(ui, |ui| {
                ui.horizontal_top(|ui| {
                    ui.label(RichText::new(mark(self.severity)).color(color).strong());
                    let width = ui.available_width() - 28.0;
                    let text = match self.times {
                        1 => self.text.clone(),
                        times => format!("{} ({times} ×)", self.text),
                    };
                    ui.vertical(|ui| {
                        ui.set_width(width);
                        let label = ui.add(Label::new(&text).wrap());
                        label.ctx.accesskit_node_builder(label.id, |node| {
                            let urgent = self.severity == Severity::Error;
                            node.set_role(if urgent { Role::Alert } else { Role::Status });
                            node.set_live(if urgent { Live::Assertive } else { Live::Polite });
                            node.set_label(text);
                        });
                    });
                    let close = ui.add(Button::new("×").frame(false));
                    close
                        .accessible_name(language.say(DISMISS))
                        .on_hover_text(language.say(DISMISS))
                        .clicked()
                })
                .inner
            })
            .inner
    }
}

const fn mark(severity: Severity) -> &'static str {
    match severity {
        Severity::Info => "i",
        Severity::Warning | Severity::Error => "!",
    }
}

/// The height of the list of faults, in points: a scene's author sees several, and the picture below them.
const FAULTS_HEIGHT: f32 = 220.0;

/// Draws the faults of a file, each with its line. Returns whether they are dismissed.
#[must_use]
pub fn show_faults(
    ui: &mut Ui,
    source: &Source,
    faults: &[Diagnostic],
    language: Language,
    actions: &mut Vec<Action>,
) -> bool {
    const CANNOT: Phrase = Phrase::new("cannot be shown", "ne peut pas être affiché");
    const RELOAD: Phrase = Phrase::new("Reload", "Recharger");
    let color = ui.visuals().error_fg_color;
    let frame = Frame::new().fill(ui.visuals().extreme_bg_color).stroke(Stroke::new(1.0, color));
    let mut dismissed = false;
    frame.inner_margin(Margin::symmetric(12, 8)).show(ui, |ui| {
        ui.horizontal(|ui| {
            let text = format!("{} {}", source.title(), language.say(CANNOT));
            let title = ui.label(RichText::new(&text).color(color).strong());
            title.ctx.accesskit_node_builder(title.id, |node| {
                node.set_role(Role::Alert);
                node.set_live(Live::Assertive);
                node.set_label(text);
            });
            if ui.button(language.say(RELOAD)).clicked() {
                actions.push(Action::Open(source.clone()));
            }
            dismissed = ui.button(language.say(DISMISS)).clicked();
        });
        let area = ScrollArea::vertical().max_height(FAULTS_HEIGHT).min_scrolled_height(FAULTS_HEIGHT);
        area.auto_shrink([false, true]).show(ui, |ui| {
            for fault in faults {
                ui.add_space(4.0);
                show_fault(ui, fault, language);
            }
        });
    });
    dismissed
}

fn show_fault(ui: &mut Ui, fault: &Diagnostic, language: Language) {
    const HINT: Phrase = Phrase::new("Hint:", "Conseil :");
    let place = match fault.location {
        Some(at) => format!("{}:{}:{}", fault.file.display(), at.line, at.column),
        None => fault.file.display().to_string(),
    };
    ui.label(RichText::new(place).weak());
    ui.label(&fault.message);
    if let Some(excerpt) = fault.excerpt() {
        ui.add(Label::new(RichText::new(excerpt).text_style(TextStyle::Monospace)).extend());
    }
    if let Some(hint) = &fault.hint {
        ui.label(RichText::new(format!("{} {hint}", language.say(HINT))).italics());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::{NodeT as _, Queryable as _};

    #[test]
    fn messages_pass_and_errors_stay() {
        let mut messages = Messages::default();
        messages.info("saved");
        messages.warning("odd");
        messages.error("not saved");
        let shown =
            |messages: &Messages| messages.list.iter().map(|message| message.severity).collect::<Vec<_>>();
        messages.pass(5.0);
        assert_eq!(shown(&messages), [Severity::Warning, Severity::Error]);
        messages.pass(1e6);
        assert_eq!(shown(&messages), [Severity::Error]);
        assert_eq!(messages.time_left(), None, "nothing is to be drawn again for what stays");
    }

    #[test]
    fn what_is_said_again_is_counted_and_starts_anew() {
        let mut messages = Messages::default();
        messages.info("saved");
        messages.pass(3.0);
        messages.info("saved");
        messages.pass(3.0);
        assert_eq!((messages.list.len(), messages.list[0].times), (1, 2));
    }

    #[test]
    fn errors_are_not_pushed_out_by_others() {
        let mut messages = Messages::default();
        messages.error("not saved");
        for i in 0..20 {
            messages.info(i.to_string());
        }
        assert_eq!((messages.list.len(), messages.list[0].severity), (MOST, Severity::Error));
    }

    #[test]
    fn a_message_has_its_role_and_is_dismissed_by_name_in_both_languages() {
        for (language, dismiss) in [(Language::English, "Dismiss"), (Language::French, "Fermer")] {
            let mut messages = Messages::default();
            messages.error("not saved");
            let mut window = crate::theme::test_window([600.0, 400.0]).build_ui_state(
                move |ui, messages: &mut Messages| messages.show(ui.ctx(), ui.max_rect(), language),
                messages,
            );
            window.run();
            assert_eq!(window.get_by_label("not saved").accesskit_node().role(), Role::Alert);
            window.get_by_label(dismiss).click();
            window.run();
            assert!(window.state().list.is_empty());
        }
    }

    #[derive(Default)]
    struct Faults {
        dismissed: bool,
        actions: Vec<Action>,
    }

    fn faults(language: Language) -> Harness<'static, Faults> {
        let text = "objects:\n  - sphere: {radius: -1}\n";
        let faults = vec![
            Diagnostic::new("scene.yaml", "radius is -1, must be positive")
                .at(2, 22)
                .showing(text)
                .with_hint("use 1"),
            Diagnostic::new("bunny.ply", "is missing"),
        ];
        let source = Source::File("scene.yaml".into());
        crate::theme::test_window([600.0, 400.0]).build_ui_state(
            move |ui, state: &mut Faults| {
                state.dismissed |= show_faults(ui, &source, &faults, language, &mut state.actions);
            },
            Faults::default(),
        )
    }

    #[test]
    fn faults_are_shown_with_their_places_lines_and_hints() {
        let window = faults(Language::French);
        for expected in ["scene.yaml:2:22", "radius is -1, must be positive", "Conseil : use 1", "bunny.ply"]
        {
            window.get_by_label(expected);
        }
        window.get_by_label_contains("2 |   - sphere: {radius: -1}");
    }

    #[test]
    fn a_file_with_faults_is_opened_again_or_dismissed() {
        for (language, reload, dismiss) in
            [(Language::English, "Reload", "Dismiss"), (Language::French, "Recharger", "Fermer")]
        {
            let mut window = faults(language);
            window.get_by_label(reload).click();
            window.run();
            assert!(matches!(&window.state().actions[..], [Action::Open(Source::File(_))]));
            window.get_by_label(dismiss).click();
            window.run();
            assert!(window.state().dismissed);
        }
    }
}
