//! One scene a file.

pub(crate) mod ten_thousand;
