//! The views of a [`Report`](crate::result::Report): text, JSON, JUnit and HTML with pictures, and the folder of them all.

mod folder;
mod html;
mod json;
mod junit;
mod pictures;
pub mod wording;

pub use folder::check as check_folder;
pub use folder::{ReportError, ReportFolder};
pub use html::document;
pub use html::render as html;
pub use json::render as json;
pub use junit::render as junit;
