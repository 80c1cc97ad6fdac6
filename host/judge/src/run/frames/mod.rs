//! Frames through a board: the tables before them, their rows, and what is judged when the last one has come back.

pub(super) mod counters;
mod entry;
mod frame_clock;
mod in_flight;
pub(super) mod kept;
mod lost_row;
pub(super) mod observations;
pub(super) mod pauses;
pub(super) mod prepared;
pub(super) mod row_judge;
mod streaming;
mod upload;
mod what_came;
