//! One scene a file.
