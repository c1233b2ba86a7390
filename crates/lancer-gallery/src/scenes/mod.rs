//! One scene a file.

pub(crate) mod mirror_room;
pub(crate) mod ten_thousand;
