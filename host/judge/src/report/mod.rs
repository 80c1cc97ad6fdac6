//! The views of a [`Report`]: text, JSON, JUnit and HTML with pictures, and the folder that holds them.

mod folder;
mod html;
mod json;
mod junit;
pub mod pictures;
mod shell;
pub mod wording;

pub use folder::check as check_folder;
pub use folder::{ReportError, ReportFolder};
pub use html::document as html_document;
pub use html::render as html;
pub use json::render as json;
pub use junit::document as junit_document;
pub use junit::render as junit;
pub use shell::shell_word;

use crate::result::{Evidence, Report};

/// A view in a report's folder.
struct View {
    /// The name of its file.
    name: &'static str,
    render: fn(&Report, &[Evidence]) -> Result<String, ReportError>,
}

/// The views in a report's folder besides its JSON, by which the folder is recognised. A new one is a module and a line here.
const VIEWS: [View; 2] = [
    View { name: "report.xml", render: |report, _| Ok(junit::render(report)?) },
    View { name: "report.html", render: |report, evidence| Ok(html::render(report, evidence)?) },
];
