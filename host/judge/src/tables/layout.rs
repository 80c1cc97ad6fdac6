//! The layout of table files: one key, several entries or one node a line.

use halfrow_model::Kernel;
use serde_json::{Map, Value};

use super::{DATAPATH, KernelFile, Place, TableFile, datapath_of};

/// Entries a line: at 8 digits and a comma each they fill about a hundred columns.
const ENTRIES_A_LINE: usize = 10;

/// The text of a table file, with its members in the order of [`TableFile::KEYS`] or [`TableFile::GRID_KEYS`].
pub(super) fn table_file(file: &TableFile) -> String {
    let geometry = file.tables.geometry();
    let entries: Vec<_> = file.tables.entries().map(|units| units.to_string()).collect();
    let shape = file.tables.shape();
    let keys = if shape.is_some() { &TableFile::GRID_KEYS[..] } else { &TableFile::KEYS };
    let members = keys.iter().filter_map(|&place| match place {
        Place::Datapath => Some((place, datapath_of(&file.tables).to_string())),
        Place::Width => Some((place, geometry.width().to_string())),
        Place::Height => Some((place, geometry.height().to_string())),
        Place::Bits => Some((place, geometry.depth().bits().to_string())),
        Place::Centre2 => Some((place, geometry.centre2().to_string())),
        Place::V => Some((place, shape?.v().to_string())),
        Place::K => Some((place, shape?.k().to_string())),
        Place::RowFactors | Place::Grid => Some((place, list(&entries, ENTRIES_A_LINE))),
        other => shared_member(other, &file.kernel, file.about.as_ref()),
    });
    object(members)
}

/// The text of a kernel file, with its members in the order of [`KernelFile::KEYS`].
pub(super) fn kernel_file(file: &KernelFile) -> String {
    let member = |place| shared_member(place, &file.kernel, file.about.as_ref());
    object(KernelFile::KEYS.into_iter().filter_map(member))
}

/// A member that both kinds of file have.
fn shared_member(
    place: Place,
    kernel: &Kernel,
    about: Option<&Map<String, Value>>,
) -> Option<(Place, String)> {
    let value = match place {
        Place::Datapath => DATAPATH.to_string(),
        Place::About => Value::Object(about?.clone()).to_string(),
        Place::Kernel => list(&kernel.nodes().map(|node| format!("{node:?}")), 1),
        _ => return None,
    };
    Some((place, value))
}

fn object(members: impl Iterator<Item = (Place, String)>) -> String {
    let members: Vec<_> = members.map(|(place, value)| format!("  \"{}\": {value}", place.key())).collect();
    format!("{{\n{}\n}}\n", members.join(",\n"))
}

fn list(entries: &[String], a_line: usize) -> String {
    let lines: Vec<_> = entries.chunks(a_line).map(|line| format!("    {}", line.join(", "))).collect();
    format!("[\n{}\n  ]", lines.join(",\n"))
}
