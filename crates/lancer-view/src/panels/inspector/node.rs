//! A node: its name, whether it is drawn, where it is, and of what.

use super::controls::{LARGE, numbers, speed_of};
use super::pose::Pose;
use super::{InspectorState, Parameter, Rows, View, Wish, heading, material};
use crate::{Action, Edit, Language, Phrase, Selection, panels::scene_tree};
use eframe::egui::{ComboBox, ScrollArea, Ui};
use lancer_core::geometry::{DMat3, DVec3, Placement, Transform};
use lancer_core::scene::{MaterialId, NodeId, Scene};

/// A pose that was set, the transform that it made, and whose it is.
pub(super) type LastPose = (NodeId, Transform, Pose);

/// Draws the node, and says what is changed about it.
pub(super) fn show(view: &mut View, ui: &mut Ui, id: NodeId, state: &mut InspectorState) {
    if !view.has_node(id) {
        return;
    }
    let node = view.document.scene().node(id);
    let saved = view.document.saved().node(id);
    let (mut name, mut is_visible) = (node.name.clone(), !node.hidden);
    let rows = &mut Rows { ui, language: view.language };
    rows.text(&NAME, &mut name, saved.name.clone());
    rows.switch(&VISIBLE, &mut is_visible, !saved.hidden);
    if name != node.name {
        view.edit(Edit::NodeName(id, name));
    }
    if is_visible == node.hidden {
        view.once(Edit::Hidden(id, !is_visible));
    }
    if let Some(transform) = transform(ui, view.language, id, &node.transform, &saved.transform, state) {
        state.refused = Placement::new(transform).is_err().then_some(FLAT);
        if state.refused.is_none() {
            view.edit(Edit::Transform(id, transform));
        }
    }
    let chosen = choice_of_material(ui, view.language, view.document.scene(), node.material, saved.material);
    if chosen != node.material {
        view.once(Edit::NodeMaterial(id, chosen));
    }
    if let Some(id) = node.material {
        let title = scene_tree::name_of(Selection::Material(id), view.document.scene(), view.language);
        let phrase = Phrase::new("Material: ", "Matériau : ");
        ui.separator();
        heading(ui, &format!("{}{title}", view.language.say(phrase)));
        ui.push_id("material", |ui| material::show(view, ui, id, &mut state.split, false));
        let alone = Phrase::new("Select the material", "Sélectionner le matériau");
        if ui.button(view.language.say(alone)).clicked() {
            view.wishes.push(Wish::Once(Action::Select(Selection::Material(id))));
        }
    }
}

/// Draws the transform. Returns the new one, if it was changed.
fn transform(
    ui: &mut Ui,
    language: Language,
    id: NodeId,
    transform: &Transform,
    saved: &Transform,
    state: &mut InspectorState,
) -> Option<Transform> {
    let last = state.pose.filter(|(of, made, _)| *of == id && made == transform).map(|(.., pose)| pose);
    let Some(pose) = last.or_else(|| Pose::of(transform)) else {
        return matrix(ui, language, transform);
    };
    let own = Pose::of(saved).unwrap_or(pose);
    let mut edited = pose;
    let rows = &mut Rows { ui, language };
    let speed = speed_of(pose.translation.abs().max_element());
    rows.vector(&TRANSLATION, &mut edited.translation, own.translation, -LARGE..=LARGE, speed);
    rows.vector(&ROTATION, &mut edited.degrees, own.degrees, -36_000.0..=36_000.0, 0.5);
    rows.vector(&SCALE, &mut edited.scale, own.scale, -LARGE..=LARGE, 0.005);
    if edited == pose {
        return None;
    }
    let made = if edited == own {
        // Set back whole: with every bit of what was loaded.
        *saved
    } else if edited.degrees == pose.degrees && edited.scale == pose.scale {
        // A shift leaves the rest as it is, to the last bit.
        from_linear(transform.linear(), edited.translation)
    } else {
        edited.transform()
    };
    state.pose = Some((id, made, edited));
    Some(made)
}

/// The twelve numbers of a transform that is more than a pose.
fn matrix(ui: &mut Ui, language: Language, transform: &Transform) -> Option<Transform> {
    let phrase = Phrase::new("Matrix, into the parent’s space", "Matrice, vers l’espace du parent");
    ui.label(language.say(phrase));
    let (mut linear, mut translation) = (transform.linear(), transform.translation());
    for row in 0..3 {
        let name = |column: usize| match language {
            Language::English => format!("Matrix, row {}, column {}", row + 1, column + 1),
            Language::French => format!("Matrice, ligne {}, colonne {}", row + 1, column + 1),
        };
        let DMat3 { x_axis, y_axis, z_axis } = &mut linear;
        numbers(
            ui,
            language,
            [
                (&mut x_axis[row], name(0)),
                (&mut y_axis[row], name(1)),
                (&mut z_axis[row], name(2)),
                (&mut translation[row], name(3)),
            ],
        );
    }
    let made = from_linear(linear, translation);
    (made != *transform).then_some(made)
}

fn from_linear(linear: DMat3, translation: DVec3) -> Transform {
    Transform::from_columns(linear.x_axis, linear.y_axis, linear.z_axis, translation)
}

/// A list of the materials, of which only those in sight are drawn: there may be thousands.
fn choice_of_material(
    ui: &mut Ui,
    language: Language,
    scene: &Scene,
    current: Option<MaterialId>,
    own: Option<MaterialId>,
) -> Option<MaterialId> {
    let name = |id: Option<MaterialId>| match id {
        Some(id) => scene_tree::name_of(Selection::Material(id), scene, language),
        None => language.say(Phrase::new("As its parent", "Comme son parent")).to_owned(),
    };
    let mut chosen = current;
    Rows { ui, language }.row(&MATERIAL, &mut chosen, own, |ui, label, chosen| {
        ComboBox::from_id_salt("material")
            .selected_text(name(*chosen))
            .width(ui.available_width())
            .height(f32::INFINITY)
            .truncate()
            .show_ui(ui, |ui| {
                let ids = scene.material_ids();
                let height = ui.spacing().interact_size.y;
                let area = ScrollArea::vertical().max_height(LIST_HEIGHT);
                area.show_rows(ui, height, ids.len() + 1, |ui, range| {
                    for id in std::iter::once(None).chain(ids.map(Some)).skip(range.start).take(range.len()) {
                        ui.selectable_value(chosen, id, name(id));
                    }
                });
            })
            .response
            .labelled_by(label)
    });
    chosen
}

/// The height of an open list, in points.
const LIST_HEIGHT: f32 = 240.0;

const FLAT: Phrase = Phrase::new(
    "That would flatten the object, so it stays as it was. Each factor must differ from 0.",
    "Cela aplatirait l’objet, qui reste donc tel quel. Chaque facteur doit différer de 0.",
);

const NAME: Parameter = Parameter {
    name: Phrase::new("Name", "Nom"),
    meaning: Phrase::new("What the object is called", "Comment s’appelle l’objet"),
};

const VISIBLE: Parameter = Parameter {
    name: Phrase::same("Visible"),
    meaning: Phrase::new(
        "Whether it is drawn, with all that lies below it in the tree",
        "S’il est dessiné, avec tout ce qui est sous lui dans l’arbre",
    ),
};

const TRANSLATION: Parameter = Parameter {
    name: Phrase::same("Translation"),
    meaning: Phrase::new(
        "How far it is moved in its parent’s space, after it was scaled and turned",
        "De combien il est déplacé dans l’espace de son parent, une fois mis à l’échelle et tourné",
    ),
};

const ROTATION: Parameter = Parameter {
    name: Phrase::same("Rotation"),
    meaning: Phrase::new(
        "In degrees about the axes x, y and z of its parent, in this order",
        "En degrés autour des axes x, y et z de son parent, dans cet ordre",
    ),
};

const SCALE: Parameter = Parameter {
    name: Phrase::new("Scale", "Échelle"),
    meaning: Phrase::new(
        "One factor along each of its own axes; a negative one mirrors it, and 0 is refused",
        "Un facteur le long de chacun de ses axes ; négatif, il fait miroir, et 0 est refusé",
    ),
};

const MATERIAL: Parameter = Parameter {
    name: Phrase::new("Material", "Matériau"),
    meaning: Phrase::new(
        "What it is made of, with all below that name no material of their own",
        "De quoi il est fait, avec tout ce qui dessous ne nomme pas son propre matériau",
    ),
};
