//! The views of a report, on reports made by hand.

mod folder;
mod html;
mod junit;
mod made;
mod pictures;
mod text;
