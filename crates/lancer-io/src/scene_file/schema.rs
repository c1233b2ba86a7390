//! The JSON Schema of scene files.

use super::model::SceneFile;
use schemars::generate::SchemaSettings;

/// The JSON Schema (draft 2020-12) of scene files, for editors and programs that write them; made from the types
/// that read them.
///
/// ```
/// let schema = lancer_io::scene_file::json_schema();
/// assert!(schema.contains("shininess"));
/// ```
pub fn json_schema() -> String {
    let schema = SchemaSettings::draft2020_12().into_generator().into_root_schema_for::<SceneFile>();
    serde_json::to_string_pretty(&schema).expect("a schema has only text for keys")
}
