//! How the window looks: calm, so that the picture is what one sees, in light and dark.

use eframe::egui::style::WidgetVisuals;
use eframe::egui::{
    Color32, Context, CornerRadius, FontDefinitions, FontFamily, Margin, Shadow, Stroke, Style, TextStyle,
    Theme as Shade, ThemePreference, Visuals, vec2,
};

/// Gives a window both looks; it then follows the system until [`choose`] says otherwise.
pub fn install(ctx: &Context) {
    // The monospaced font has the arrows and the signs of mathematics that the other one lacks.
    let mut fonts = FontDefinitions::default();
    let fallbacks = fonts.families.get(&FontFamily::Monospace).cloned().unwrap_or_default();
    let family = fonts.families.entry(FontFamily::Proportional).or_default();
    let missing = fallbacks.into_iter().filter(|font| !family.contains(font)).collect::<Vec<_>>();
    family.extend(missing);
    ctx.set_fonts(fonts);
    for shade in [Shade::Dark, Shade::Light] {
        ctx.style_mut_of(shade, |style| set(style, &Palette::of(shade)));
    }
}

/// Chooses light or dark, or the system's.
pub fn choose(ctx: &Context, theme: crate::Theme) {
    ctx.set_theme(match theme {
        crate::Theme::System => ThemePreference::System,
        crate::Theme::Light => ThemePreference::Light,
        crate::Theme::Dark => ThemePreference::Dark,
    });
}

/// The few colours of a look. Greys have no hue of their own: beside a picture they would tint it.
struct Palette {
    shade: Shade,
    /// Behind panels.
    ground: Color32,
    /// Behind dialogs and menus, which lie above.
    raised: Color32,
    /// Behind what is typed.
    field: Color32,
    /// Buttons at rest, under the mouse, and pressed.
    button: [Color32; 3],
    /// Lines between things.
    line: Color32,
    text: Color32,
    strong_text: Color32,
    weak_text: Color32,
    /// The one colour: what is chosen, and what is to be done.
    accent: Color32,
    on_accent: Color32,
    link: Color32,
    warning: Color32,
    error: Color32,
}

impl Palette {
    const fn of(shade: Shade) -> Self {
        let grey = Color32::from_gray;
        match shade {
            Shade::Dark => Self {
                shade,
                ground: grey(30),
                raised: grey(38),
                field: grey(20),
                button: [grey(52), grey(64), grey(74)],
                line: grey(58),
                text: grey(208),
                strong_text: grey(240),
                weak_text: grey(155),
                accent: Color32::from_rgb(36, 104, 176),
                on_accent: Color32::WHITE,
                link: Color32::from_rgb(110, 175, 240),
                warning: Color32::from_rgb(240, 175, 70),
                error: Color32::from_rgb(255, 120, 110),
            },
            Shade::Light => Self {
                shade,
                ground: grey(243),
                raised: grey(252),
                field: Color32::WHITE,
                button: [grey(224), grey(212), grey(200)],
                line: grey(208),
                text: grey(45),
                strong_text: grey(10),
                weak_text: grey(95),
                accent: Color32::from_rgb(36, 104, 176),
                on_accent: Color32::WHITE,
                link: Color32::from_rgb(20, 90, 170),
                warning: Color32::from_rgb(140, 80, 0),
                error: Color32::from_rgb(180, 30, 25),
            },
        }
    }
}

fn set(style: &mut Style, palette: &Palette) {
    style.visuals = visuals(palette);
    let spacing = &mut style.spacing;
    spacing.item_spacing = vec2(8.0, 5.0);
    spacing.button_padding = vec2(8.0, 3.0);
    spacing.interact_size = vec2(40.0, 22.0);
    spacing.menu_margin = Margin::same(6);
    spacing.window_margin = Margin::same(14);
    spacing.tooltip_width = 320.0;
    // Lists that drop down are no taller than this: all built-in scenes and the recent files fit.
    spacing.default_area_size = vec2(600.0, 640.0);
    for (text_style, size) in [(TextStyle::Body, 13.5), (TextStyle::Button, 13.5), (TextStyle::Small, 11.0)] {
        if let Some(font) = style.text_styles.get_mut(&text_style) {
            font.size = size;
        }
    }
}

fn visuals(palette: &Palette) -> Visuals {
    let mut visuals = match palette.shade {
        Shade::Dark => Visuals::dark(),
        Shade::Light => Visuals::light(),
    };
    let rounding = CornerRadius::same(5);
    let widget = |fill: Color32, line: Color32, text: Color32| WidgetVisuals {
        bg_fill: fill,
        weak_bg_fill: fill,
        bg_stroke: Stroke::new(1.0, line),
        corner_radius: rounding,
        fg_stroke: Stroke::new(1.0, text),
        expansion: 0.0,
    };
    let [rest, hovered, pressed] = palette.button;
    visuals.widgets.noninteractive = widget(palette.ground, palette.line, palette.text);
    visuals.widgets.inactive = widget(rest, Color32::TRANSPARENT, palette.text);
    visuals.widgets.hovered = widget(hovered, palette.line, palette.strong_text);
    // What has the keyboard is drawn as pressed: the line tells where it is.
    visuals.widgets.active = widget(pressed, palette.accent, palette.strong_text);
    visuals.widgets.open = widget(pressed, palette.line, palette.strong_text);
    visuals.weak_text_color = Some(palette.weak_text);
    visuals.selection.bg_fill = palette.accent;
    visuals.selection.stroke = Stroke::new(1.0, palette.on_accent);
    visuals.hyperlink_color = palette.link;
    visuals.warn_fg_color = palette.warning;
    visuals.error_fg_color = palette.error;
    visuals.panel_fill = palette.ground;
    visuals.window_fill = palette.raised;
    visuals.window_stroke = Stroke::new(1.0, palette.line);
    visuals.window_corner_radius = CornerRadius::same(8);
    visuals.menu_corner_radius = CornerRadius::same(6);
    visuals.extreme_bg_color = palette.field;
    visuals.faint_bg_color = palette.raised;
    visuals.code_bg_color = palette.field;
    visuals.indent_has_left_vline = false;
    let shadow =
        |blur, alpha| Shadow { offset: [0, 4], blur, spread: 0, color: Color32::from_black_alpha(alpha) };
    visuals.popup_shadow = shadow(12, 60);
    visuals.window_shadow = shadow(24, 90);
    visuals
}

/// A window for tests that looks as the real one does; it panics at a glyph that no font has.
#[cfg(test)]
pub(crate) fn test_window<S>(size: [f32; 2]) -> egui_kittest::HarnessBuilder<S> {
    egui_kittest::Harness::builder().with_size(size).with_context_setup(install)
}

#[cfg(test)]
mod tests {
    use super::*;
    use lancer_core::Rgb;

    /// How well a colour is told from the one behind it: 1 to 21. Source: WCAG 2.2, "contrast ratio".
    fn contrast(one: Color32, other: Color32) -> f64 {
        let luminance = |color: Color32| {
            let [r, g, b, _] = color.to_array().map(u32::from);
            let Rgb { r, g, b } = Rgb::from_srgb_hex(r << 16 | g << 8 | b);
            0.2126 * r + 0.7152 * g + 0.0722 * b + 0.05
        };
        let (one, other) = (luminance(one), luminance(other));
        one.max(other) / one.min(other)
    }

    #[test]
    fn every_text_is_readable_on_all_that_it_stands_on() {
        for shade in [Shade::Dark, Shade::Light] {
            let palette = Palette::of(shade);
            let texts = [
                palette.text,
                palette.strong_text,
                palette.weak_text,
                palette.link,
                palette.warning,
                palette.error,
            ];
            for ground in [palette.ground, palette.raised, palette.field] {
                for text in texts {
                    assert!(contrast(text, ground) >= 4.5, "{shade:?}: {text:?} on {ground:?}");
                }
            }
            for button in palette.button {
                assert!(contrast(palette.text, button) >= 4.5, "{shade:?}: {button:?}");
            }
            assert!(contrast(palette.on_accent, palette.accent) >= 4.5, "{shade:?}");
        }
    }

    #[test]
    fn the_accent_is_seen_on_every_ground() {
        for shade in [Shade::Dark, Shade::Light] {
            let palette = Palette::of(shade);
            for ground in [palette.ground, palette.raised, palette.field] {
                assert!(contrast(palette.accent, ground) >= 2.5, "{shade:?}: {ground:?}");
            }
        }
    }

    #[test]
    fn a_chosen_theme_is_that_of_the_next_frame() {
        let ctx = Context::default();
        install(&ctx);
        for (theme, dark) in [(crate::Theme::Dark, true), (crate::Theme::Light, false)] {
            choose(&ctx, theme);
            let mut output = ctx.run_ui(eframe::egui::RawInput::default(), |ui| {
                assert_eq!(ui.visuals().dark_mode, dark);
                assert_eq!(ui.visuals().panel_fill, Palette::of(ui.theme()).ground);
            });
            output.textures_delta.clear();
        }
    }
}
