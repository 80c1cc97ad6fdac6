//! Options that several commands share, and where the value of an option comes from.

pub(crate) mod board;
pub(crate) mod given;
pub(crate) mod inputs;
pub(crate) mod judging;
pub(crate) mod optics;
pub(crate) mod table_file;
