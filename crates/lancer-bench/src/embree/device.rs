//! Where Embree is.

use super::ffi::Library;
use crate::Failure;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

/// The environment variable that names the library.
const VARIABLE: &str = "LANCER_EMBREE";

/// Loads Embree from `path`, else from where the environment says, else from Python's package `embreex`, else from
/// the system, version 4 before version 3.
pub(crate) fn find(path: Option<&Path>) -> Result<Arc<Library>, Failure> {
    let named = path.map(Path::to_path_buf).or_else(|| std::env::var_os(VARIABLE).map(PathBuf::from));
    if let Some(path) = named {
        return Library::open(&path).map_err(|error| format!("{}: {error}", path.display()).into());
    }
    let system = ["libembree4.so.4", "libembree4.so", "libembree3.so.3", "libembree3.so"].map(PathBuf::from);
    from_python().into_iter().chain(system).find_map(|path| Library::open(&path).ok()).ok_or_else(|| {
        format!(
            "Embree was not found. `pip install embreex` brings version 4.4; Debian's `libembree3-3` is version \
             3.13. --embree or the variable {VARIABLE} names the library where it lies elsewhere."
        )
        .into()
    })
}

/// The library inside of the wheel, which pip puts beside the package.
fn from_python() -> Option<PathBuf> {
    let script = "import embreex, os; print(os.path.dirname(os.path.dirname(embreex.__file__)))";
    let output = Command::new("python3").args(["-c", script]).output().ok()?;
    let packages = PathBuf::from(String::from_utf8(output.stdout).ok()?.trim());
    let entries = std::fs::read_dir(packages.join("embreex.libs")).ok()?;
    entries.flatten().map(|entry| entry.path()).find(|path| {
        path.file_name().and_then(|name| name.to_str()).is_some_and(|name| name.starts_with("libembree4"))
    })
}
