//! What a step measured, as evidence.

use std::path::Path;

use serde::Serialize;
use serde_json::Value;

use super::kept_frame::{NotKept, tell};
use super::message::MOST_LINE;

/// The longest report that is kept, in bytes of JSON. What a lane says beside it has room in the same line.
const MOST_REPORT: usize = MOST_LINE - (1 << 20);

/// The `report` of a try of a step. One that is too long for a line is named among what is not kept in `folder`: no verdict
/// depends on it.
pub(super) fn kept(folder: &Path, (seq, attempt): (u32, u32), report: &impl Serialize) -> Option<Value> {
    let bytes = serde_json::to_vec(report).ok()?;
    if bytes.len() > MOST_REPORT {
        tell(folder, &format!("the report of step {seq}, try {attempt},"), NotKept::LongReport);
        return None;
    }
    serde_json::from_slice(&bytes).ok()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::super::kept_frame::NOT_KEPT;
    use super::*;

    #[test]
    fn a_report_that_no_line_has_room_for_is_named_and_costs_no_verdict() {
        let folder = tempfile::tempdir().unwrap();
        let long = "x".repeat(MOST_LINE);
        assert_eq!(kept(folder.path(), (1, 1), &["short"]), Some(Value::from(vec!["short"])));
        assert!(!folder.path().join(NOT_KEPT).exists());
        assert_eq!(kept(folder.path(), (2, 3), &long), None);
        let told = fs::read_to_string(folder.path().join(NOT_KEPT)).unwrap();
        assert!(told.starts_with("the report of step 2, try 3, is not kept"), "{told}");
    }
}
