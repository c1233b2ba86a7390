//! The table of commands: a row has the command, its kind, what it needs, its keys, its name and its description.

use super::Kind::{Act, Choice, Toggle};
use super::Needs::{
    Changes, Document, File, Hidden, Hideable, Nothing, Redo, Render, Renders, Selection, SeveralRenders,
    Undo, Work,
};
use super::{Entry, Menu};
use crate::Phrase;
use eframe::egui::{Key, KeyboardShortcut, Modifiers};

const fn key(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::NONE, key)
}

const fn shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::SHIFT, key)
}

const fn alt(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::ALT, key)
}

const fn ctrl(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND, key)
}

const fn ctrl_shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), key)
}

/// Makes the type and its table from the same rows, so that they cannot fall apart.
macro_rules! commands {
    ($($menu:ident { $(
        $command:ident $kind:ident $needs:ident [$($shortcut:expr),*]
            ($name:literal, $nom:literal)
            ($description:literal, $aide:literal);
    )* })*) => {
        /// Something that a user can tell the window to do.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Command {
            $($(
                #[doc = concat!($description, ".")]
                $command,
            )*)*
        }

        impl Command {
            /// All of them, menu by menu.
            pub const ALL: &'static [Self] = &[$($(Self::$command,)*)*];

            pub(super) const fn entry(self) -> &'static Entry {
                &TABLE[self as usize]
            }
        }

        const TABLE: &[Entry] = &[$($(Entry {
            menu: Menu::$menu,
            kind: $kind,
            needs: $needs,
            shortcuts: &[$($shortcut),*],
            name: Phrase::new($name, $nom),
            description: Phrase::new($description, $aide),
        },)*)*];
    };
}

commands! {
    File {
        Open Act Nothing [ctrl(Key::O)]
            ("Open…", "Ouvrir…")
            ("Show a scene file or a model", "Afficher un fichier de scène ou un modèle");
        Reload Act File [ctrl(Key::R), key(Key::F5)]
            ("Reload", "Recharger")
            ("Read the scene’s file again", "Relire le fichier de la scène");
        SaveScene Act Document [ctrl(Key::S)]
            ("Save view into scene file", "Enregistrer la vue dans la scène")
            ("Write the camera and what was changed into the scene’s file, and keep the rest of it",
             "Écrire la caméra et ce qui a été modifié dans le fichier de la scène, en gardant le reste");
        SaveSceneAs Act Document [ctrl_shift(Key::S)]
            ("Save scene as…", "Enregistrer la scène sous…")
            ("Write the whole scene into a new file", "Écrire toute la scène dans un nouveau fichier");
        SavePicture Act Document [ctrl(Key::E)]
            ("Save picture…", "Enregistrer l’image…")
            ("Write the picture that is shown as PNG or EXR", "Écrire l’image affichée en PNG ou EXR");
        CopyPicture Act Document [ctrl_shift(Key::C), ctrl(Key::C)]
            ("Copy picture", "Copier l’image")
            ("Put the picture that is shown on the clipboard", "Mettre l’image affichée dans le presse-papiers");
        Quit Act Nothing [ctrl(Key::Q)]
            ("Quit", "Quitter")
            ("Close the window", "Fermer la fenêtre");
    }
    Edit {
        Undo Act Undo [ctrl(Key::Z)]
            ("Undo", "Annuler la modification")
            ("Take back the last change of the scene", "Revenir sur la dernière modification de la scène");
        Redo Act Redo [ctrl_shift(Key::Z), ctrl(Key::Y)]
            ("Redo", "Rétablir")
            ("Make the change again that was taken back", "Refaire la modification annulée");
        Revert Act Changes []
            ("Revert all changes", "Revenir à l’original")
            ("Take back all that was changed since the scene was opened or saved",
             "Revenir sur tout ce qui a changé depuis l’ouverture ou l’enregistrement");
        Deselect Act Selection [ctrl(Key::D)]
            ("Deselect", "Désélectionner")
            ("Select nothing", "Ne rien sélectionner");
        HideSelection Act Hideable [key(Key::H)]
            ("Hide selection", "Masquer la sélection")
            ("Leave what is selected out of the picture", "Retirer de l’image ce qui est sélectionné");
        ShowAll Act Hidden [alt(Key::H)]
            ("Show all", "Tout afficher")
            ("Bring back everything that is hidden", "Faire réapparaître tout ce qui est masqué");
        UseViewAsCamera Act Document []
            ("Use this view as the scene’s camera", "Prendre cette vue comme caméra de la scène")
            ("Make the scene’s camera look as the view does now",
             "Donner à la caméra de la scène le point de vue actuel");
    }
    View {
        FrameAll Act Document [key(Key::F)]
            ("Frame everything", "Cadrer tout")
            ("Move the view back or forth until everything is in it",
             "Avancer ou reculer la vue pour que tout y soit");
        FrameSelection Act Selection [shift(Key::F)]
            ("Frame selection", "Cadrer la sélection")
            ("Move the view so that what is selected fills it",
             "Déplacer la vue pour que la sélection la remplisse");
        Home Act Document [key(Key::Home)]
            ("Scene’s camera", "Caméra de la scène")
            ("Go back to where the scene’s camera stands", "Revenir à la caméra de la scène");
        Front Act Document [key(Key::Num1)]
            ("Front", "Face")
            ("Look along the Z axis, from the front", "Regarder le long de l’axe Z, de face");
        Back Act Document [ctrl(Key::Num1)]
            ("Back", "Arrière")
            ("Look along the Z axis, from behind", "Regarder le long de l’axe Z, de derrière");
        Right Act Document [key(Key::Num3)]
            ("Right", "Droite")
            ("Look along the X axis, from the right", "Regarder le long de l’axe X, de droite");
        Left Act Document [ctrl(Key::Num3)]
            ("Left", "Gauche")
            ("Look along the X axis, from the left", "Regarder le long de l’axe X, de gauche");
        Top Act Document [key(Key::Num7)]
            ("Top", "Dessus")
            ("Look along the Y axis, from above", "Regarder le long de l’axe Y, d’en haut");
        Bottom Act Document [ctrl(Key::Num7)]
            ("Bottom", "Dessous")
            ("Look along the Y axis, from below", "Regarder le long de l’axe Y, d’en bas");
        ShowPicture Choice Document [alt(Key::Num1)]
            ("Picture", "Image")
            ("Show the scene as it is lit", "Montrer la scène éclairée");
        ShowDepth Choice Document [alt(Key::Num2)]
            ("Depth", "Profondeur")
            ("Show how far away surfaces are", "Montrer la distance des surfaces");
        ShowNormals Choice Document [alt(Key::Num3)]
            ("Normals", "Normales")
            ("Show which way surfaces face", "Montrer l’orientation des surfaces");
        ShowObjects Choice Document [alt(Key::Num4)]
            ("Objects", "Objets")
            ("Show each object in a colour of its own", "Montrer chaque objet dans une couleur qui lui est propre");
        ShowOcclusion Choice Document [alt(Key::Num5)]
            ("Ambient occlusion", "Occultation ambiante")
            ("Show ambient occlusion alone, c_a of the model", "Montrer l’occultation ambiante seule, c_a du modèle");
        Grid Toggle Document [key(Key::G)]
            ("Grid", "Grille")
            ("Draw a grid on the ground", "Dessiner une grille au sol");
        Axes Toggle Document [key(Key::A)]
            ("Axes", "Axes")
            ("Draw the axes of the world", "Dessiner les axes du monde");
        Lights Toggle Document [key(Key::L)]
            ("Lights", "Lumières")
            ("Mark where the lights are", "Marquer l’emplacement des lumières");
        Bounds Toggle Document [key(Key::B)]
            ("Bounding boxes", "Boîtes englobantes")
            ("Draw the box around each object", "Dessiner la boîte autour de chaque objet");
        Interest Toggle Document [key(Key::P)]
            ("Point of interest", "Point d’intérêt")
            ("Mark the point that the view turns about", "Marquer le point autour duquel la vue tourne");
        Tree Toggle Document [key(Key::T)]
            ("Tree boxes", "Boîtes de l’arbre")
            ("Draw the boxes of one level of the tree that finds hits",
             "Dessiner les boîtes d’un niveau de l’arbre qui trouve les intersections");
        TreeDeeper Act Document [key(Key::Period)]
            ("Next level of the tree", "Niveau suivant de l’arbre")
            ("Draw the boxes of the next level of the tree", "Dessiner les boîtes du niveau suivant de l’arbre");
        TreeShallower Act Document [key(Key::Comma)]
            ("Previous level of the tree", "Niveau précédent de l’arbre")
            ("Draw the boxes of the level above", "Dessiner les boîtes du niveau précédent");
        ScenePanel Toggle Nothing [key(Key::F2)]
            ("Scene panel", "Panneau de la scène")
            ("Show or hide the tree of the scene", "Afficher ou masquer l’arbre de la scène");
        SettingsPanel Toggle Nothing [key(Key::F3)]
            ("Settings panel", "Panneau des réglages")
            ("Show or hide the settings of the picture", "Afficher ou masquer les réglages de l’image");
        RendersPanel Toggle Nothing [key(Key::F4)]
            ("Renders", "Rendus")
            ("Show or hide the renders that are kept", "Afficher ou masquer les rendus conservés");
        MouseHints Toggle Nothing []
            ("Mouse hints", "Aide de la souris")
            ("Say in the view what each mouse button does", "Rappeler dans la vue le rôle des boutons de la souris");
        FullScreen Toggle Nothing [key(Key::F11)]
            ("Full screen", "Plein écran")
            ("Let the window fill the screen", "Étendre la fenêtre à tout l’écran");
        ThemeSystem Choice Nothing []
            ("Theme of the system", "Thème du système")
            ("Light or dark as the system is", "Clair ou sombre comme le système");
        ThemeLight Choice Nothing []
            ("Light theme", "Thème clair")
            ("Dark text on light ground", "Texte sombre sur fond clair");
        ThemeDark Choice Nothing []
            ("Dark theme", "Thème sombre")
            ("Light text on dark ground", "Texte clair sur fond sombre");
        LanguageSystem Choice Nothing []
            ("Language of the system", "Langue du système")
            ("Speak the language of the system", "Parler la langue du système");
        LanguageEnglish Choice Nothing []
            ("English", "English")
            ("Speak English", "Parler anglais");
        LanguageFrench Choice Nothing []
            ("Français", "Français")
            ("Speak French", "Parler français");
        MouseAssignment Choice Nothing []
            ("Mouse: left drag moves", "Souris : déplacer à gauche")
            ("Left drag moves, middle drag goes nearer or farther, right drag turns",
             "Glisser à gauche déplace, au milieu avance ou recule, à droite tourne");
        MouseOrbit Choice Nothing []
            ("Mouse: left drag turns", "Souris : tourner à gauche")
            ("Left drag turns about the point of interest, middle drag moves, right drag goes nearer or farther",
             "Glisser à gauche tourne autour du point d’intérêt, au milieu déplace, à droite avance ou recule");
        MouseTrackpad Choice Nothing []
            ("Trackpad", "Pavé tactile")
            ("Two fingers and modifier keys in place of mouse buttons",
             "Deux doigts et touches de modification au lieu des boutons de la souris");
        LargerInterface Act Nothing [ctrl(Key::Plus), ctrl(Key::Equals)]
            ("Larger text and controls", "Agrandir l’interface")
            ("Make everything but the picture larger", "Agrandir tout sauf l’image");
        SmallerInterface Act Nothing [ctrl(Key::Minus)]
            ("Smaller text and controls", "Réduire l’interface")
            ("Make everything but the picture smaller", "Réduire tout sauf l’image");
        NormalInterface Act Nothing [ctrl(Key::Num0)]
            ("Normal text and controls", "Taille normale de l’interface")
            ("Give text and controls the size that the system asks for",
             "Donner à l’interface la taille demandée par le système");
    }
    Render {
        Render Act Document [key(Key::F12), ctrl(Key::Enter)]
            ("Render", "Calculer l’image")
            ("Make the picture at the chosen size, and keep it", "Calculer l’image à la taille choisie, et la garder");
        Cancel Act Work [key(Key::Escape)]
            ("Cancel", "Interrompre")
            ("Stop rendering, or opening a scene", "Arrêter le rendu, ou l’ouverture d’une scène");
        ShowView Act Render [key(Key::V)]
            ("Back to the view", "Revenir à la vue")
            ("Show the scene to move in, in place of a render", "Montrer la scène où se déplacer, au lieu d’un rendu");
        PreviousRender Act Renders [key(Key::PageUp)]
            ("Previous render", "Rendu précédent")
            ("Show the render before this one", "Montrer le rendu d’avant");
        NextRender Act Renders [key(Key::PageDown)]
            ("Next render", "Rendu suivant")
            ("Show the render after this one", "Montrer le rendu d’après");
        Compare Toggle SeveralRenders [key(Key::C)]
            ("Compare", "Comparer")
            ("Show two renders side by side, with a line to slide between them",
             "Montrer deux rendus côte à côte, séparés par un trait à faire glisser");
        DeleteRender Act Render [key(Key::Delete)]
            ("Delete render", "Supprimer le rendu")
            ("Forget the render that is shown", "Oublier le rendu affiché");
        ZoomIn Act Render [key(Key::Plus), key(Key::Equals)]
            ("Zoom in", "Zoom avant")
            ("Show the pixels of the render larger", "Agrandir les pixels du rendu");
        ZoomOut Act Render [key(Key::Minus)]
            ("Zoom out", "Zoom arrière")
            ("Show the pixels of the render smaller", "Réduire les pixels du rendu");
        ActualSize Act Render [key(Key::Z)]
            ("Actual size", "Taille réelle")
            ("Show one pixel of the render on one of the screen", "Montrer un pixel du rendu sur un pixel de l’écran");
        Fit Act Render [key(Key::Num0)]
            ("Fit into the window", "Ajuster à la fenêtre")
            ("Show all of the render", "Montrer le rendu en entier");
    }
    Help {
        Palette Act Nothing [ctrl(Key::K), ctrl_shift(Key::P)]
            ("Command palette…", "Palette de commandes…")
            ("Find a command, a scene or a file by its name",
             "Trouver une commande, une scène ou un fichier par son nom");
        Shortcuts Act Nothing [key(Key::Questionmark), key(Key::F1)]
            ("Keyboard and mouse…", "Clavier et souris…")
            ("List the shortcuts, and what the mouse does", "Lister les raccourcis et le rôle de la souris");
        About Act Nothing []
            ("About Lancer…", "À propos de Lancer…")
            ("Say which version this is", "Indiquer la version");
    }
}
