//! Real directories, and what the dialog makes of them.

use super::*;
use std::fs;
use std::time::Duration;
use tempfile::TempDir;

/// A directory with a scene, a model, a picture, another file, a hidden one, and a directory with a scene.
fn directory() -> TempDir {
    let directory = tempfile::tempdir().unwrap();
    for name in ["b.yaml", "a.PLY", "shot.png", "notes.txt", ".hidden.yaml"] {
        fs::write(directory.path().join(name), name).unwrap();
    }
    fs::create_dir(directory.path().join("more")).unwrap();
    fs::write(directory.path().join("more/c.json"), "{}").unwrap();
    directory
}

fn picker(purpose: Purpose, directory: &Path, name: &str) -> FilePicker {
    let mut picker = FilePicker::new(purpose, directory, name, Vec::new(), || {});
    assert_eq!(settle(&mut picker), Outcome::Pending);
    picker
}

/// Waits for the disk.
fn settle(picker: &mut FilePicker) -> Outcome {
    let looking = picker.looking.as_ref().unwrap();
    let answer = looking.recv_timeout(Duration::from_secs(30)).unwrap();
    picker.answered(answer)
}

fn submit(picker: &mut FilePicker, typed: &str) -> Outcome {
    typed.clone_into(&mut picker.typed);
    picker.edited();
    picker.submit();
    settle(picker)
}

fn names(picker: &FilePicker) -> Vec<&str> {
    picker.shown().iter().map(|entry| entry.name.as_str()).collect()
}

#[test]
fn directories_come_first_and_then_the_files_that_the_purpose_is_about() {
    let directory = directory();
    assert_eq!(names(&picker(Purpose::Open, directory.path(), "")), ["more", "a.PLY", "b.yaml"]);
    assert_eq!(names(&picker(Purpose::SavePicture, directory.path(), "")), ["more", "shot.png"]);
    let mut all = picker(Purpose::Open, directory.path(), "");
    (all.shows_all, all.shows_hidden) = (true, true);
    assert_eq!(names(&all), ["more", ".hidden.yaml", "a.PLY", "b.yaml", "notes.txt", "shot.png"]);
}

#[test]
fn a_name_that_is_typed_opens_that_file() {
    let directory = directory();
    let mut picker = picker(Purpose::Open, directory.path(), "");
    assert_eq!(submit(&mut picker, " b.yaml "), Outcome::Picked(directory.path().join("b.yaml")));
}

#[test]
fn a_path_may_be_absolute_quoted_a_url_or_go_up() {
    let directory = directory();
    let wanted = directory.path().join("more/c.json");
    let absolute = wanted.display().to_string();
    for typed in [
        absolute.clone(),
        format!("'{absolute}'"),
        format!("\"{absolute}\""),
        format!("file://{absolute}"),
        "more/c.json".to_owned(),
        "./more/../more/c.json".to_owned(),
    ] {
        let mut picker = picker(Purpose::Open, directory.path(), "");
        assert_eq!(submit(&mut picker, &typed), Outcome::Picked(wanted.clone()), "{typed}");
    }
}

#[test]
fn a_tilde_is_the_home_directory() {
    let home = directories::UserDirs::new().unwrap().home_dir().to_owned();
    assert_eq!(resolve("~", Path::new("/x")), Some(home.clone()));
    assert_eq!(resolve("~/scene.yaml", Path::new("/x")), Some(home.join("scene.yaml")));
    assert_eq!(resolve("~other", Path::new("/x")), Some("/x/~other".into()));
}

#[test]
fn a_directory_is_gone_into_and_left_again() {
    let directory = directory();
    let mut picker = picker(Purpose::Open, directory.path(), "");
    assert_eq!(submit(&mut picker, "more"), Outcome::Pending);
    assert_eq!((names(&picker), picker.typed.as_str()), (vec!["c.json"], ""));
    picker.up();
    assert_eq!(settle(&mut picker), Outcome::Pending);
    assert_eq!(picker.directory(), directory.path());
}

#[test]
fn the_name_to_save_under_stays_on_the_way_to_another_directory() {
    let directory = directory();
    let mut picker = picker(Purpose::SavePicture, directory.path(), "glass.png");
    picker.move_selection(1);
    picker.submit();
    assert_eq!(settle(&mut picker), Outcome::Pending);
    picker.submit();
    assert_eq!(settle(&mut picker), Outcome::Picked(directory.path().join("more/glass.png")));
}

#[test]
fn arrows_select_and_the_selected_file_is_taken() {
    let directory = directory();
    let mut picker = picker(Purpose::Open, directory.path(), "");
    for expected in [0, 1, 2, 2] {
        picker.move_selection(1);
        assert_eq!(picker.selected, Some(expected));
    }
    assert_eq!(picker.typed, "b.yaml");
    picker.submit();
    assert_eq!(settle(&mut picker), Outcome::Picked(directory.path().join("b.yaml")));
}

#[test]
fn a_missing_extension_is_added_and_another_one_is_refused() {
    let directory = directory();
    let mut picker = picker(Purpose::SavePicture, directory.path(), "");
    assert_eq!(submit(&mut picker, "new"), Outcome::Picked(directory.path().join("new.png")));
    assert_eq!(submit(&mut picker, "new.EXR"), Outcome::Picked(directory.path().join("new.EXR")));
    assert_eq!(submit(&mut picker, "new.txt"), Outcome::Pending);
    assert_eq!(picker.fault, Some(Fault::OtherKind(Purpose::SavePicture)));
}

#[test]
fn a_file_that_is_there_is_replaced_only_when_that_is_said() {
    let directory = directory();
    let mut picker = picker(Purpose::SavePicture, directory.path(), "");
    assert_eq!(submit(&mut picker, "shot"), Outcome::Pending);
    assert_eq!(picker.to_replace, Some(directory.path().join("shot.png")));
    picker.edited();
    assert_eq!(picker.replace(), Outcome::Pending, "what was typed since is another name");
    submit(&mut picker, "shot.png");
    assert_eq!(picker.replace(), Outcome::Picked(directory.path().join("shot.png")));
}

#[test]
fn a_path_that_leads_nowhere_says_so_and_leaves_the_list() {
    let directory = directory();
    let mut open = picker(Purpose::Open, directory.path(), "");
    submit(&mut open, "none.yaml");
    assert_eq!(open.fault, Some(Fault::NoSuchFile(directory.path().join("none.yaml"))));
    submit(&mut open, "none/b.yaml");
    assert_eq!(open.fault, Some(Fault::NoSuchDirectory(directory.path().join("none"))));
    assert_eq!(names(&open), ["more", "a.PLY", "b.yaml"]);
    let mut save = picker(Purpose::SaveScene, directory.path(), "");
    submit(&mut save, "none/b.yaml");
    assert_eq!(save.fault, Some(Fault::NoSuchDirectory(directory.path().join("none"))));
}

#[test]
fn nothing_typed_and_nothing_selected_says_so() {
    let directory = directory();
    let mut picker = picker(Purpose::Open, directory.path(), "");
    picker.submit();
    assert_eq!(picker.fault, Some(Fault::NoName));
}

#[cfg(unix)]
#[test]
fn a_directory_that_may_not_be_read_says_so() {
    use std::os::unix::fs::PermissionsExt as _;
    let directory = directory();
    let locked = directory.path().join("more");
    fs::set_permissions(&locked, fs::Permissions::from_mode(0o000)).unwrap();
    // The superuser may read everything.
    if fs::read_dir(&locked).is_err() {
        let mut picker = picker(Purpose::Open, directory.path(), "");
        submit(&mut picker, "more");
        assert_eq!(picker.fault, Some(Fault::Denied(locked.clone())));
    }
    fs::set_permissions(&locked, fs::Permissions::from_mode(0o755)).unwrap();
}

#[test]
fn usual_places_are_absolute_and_each_is_there_once() {
    let recent = ["/a/b.ply", "/a/c.ply", "/d/e.yaml", "f.yaml"].map(PathBuf::from);
    let places = Place::usual(Some(Path::new("/d/e.yaml")), &recent);
    let count = |path: &str| places.iter().filter(|place| place.path == Path::new(path)).count();
    assert_eq!((count("/a"), count("/d"), count("")), (1, 1, 0));
}

#[test]
fn whoever_waits_is_woken() {
    let (sender, receiver) = channel();
    let directory = directory();
    let _picker = FilePicker::new(Purpose::Open, directory.path(), "", Vec::new(), move || {
        let _ = sender.send(());
    });
    assert_eq!(receiver.recv_timeout(Duration::from_secs(30)), Ok(()));
}
