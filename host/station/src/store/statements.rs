//! The text of every statement. SQLite and PostgreSQL have the same, but for three words.

/// The schemas, in order: numbered files that are never edited.
pub(super) const SCHEMAS: [&str; 1] = [include_str!("../../sql/schema-1.sql")];

pub(super) const SCHEMA_VERSION: &str = include_str!("../../sql/schema-version.sql");
pub(super) const ADD_PLAN: &str = include_str!("../../sql/add-plan.sql");
pub(super) const ADD_UNIT: &str = include_str!("../../sql/add-unit.sql");
pub(super) const UNIT_OF: &str = include_str!("../../sql/unit-of.sql");
pub(super) const OPEN_RUN: &str = include_str!("../../sql/open-run.sql");
pub(super) const FINISH_RUN: &str = include_str!("../../sql/finish-run.sql");
pub(super) const ADD_STEP: &str = include_str!("../../sql/add-step.sql");
pub(super) const ADD_MEASUREMENT: &str = include_str!("../../sql/add-measurement.sql");
pub(super) const ADD_SUSPECT: &str = include_str!("../../sql/add-suspect.sql");
pub(super) const ADD_ATTACHMENT: &str = include_str!("../../sql/add-attachment.sql");
pub(super) const VERDICT_OF: &str = include_str!("../../sql/verdict-of.sql");
pub(super) const OPEN_RUNS: &str = include_str!("../../sql/open-runs.sql");
pub(super) const FINAL_RUNS: &str = include_str!("../../sql/final-runs.sql");

/// The text as SQLite takes it.
pub(super) fn for_sqlite(text: &str) -> String {
    text.replace("{int}", "INTEGER").replace("{real}", "REAL").replace("{strict}", " STRICT")
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [&str; 12] = [
        ADD_PLAN,
        ADD_UNIT,
        UNIT_OF,
        OPEN_RUN,
        FINISH_RUN,
        ADD_STEP,
        ADD_MEASUREMENT,
        ADD_SUSPECT,
        ADD_ATTACHMENT,
        VERDICT_OF,
        OPEN_RUNS,
        FINAL_RUNS,
    ];

    /// SQLite numbers `$1` by where it first stands, PostgreSQL by its digits.
    #[test]
    fn parameters_are_numbered_in_the_order_of_their_first_use() {
        for text in ALL {
            let mut most = 0;
            for piece in text.split('$').skip(1) {
                let digits: String = piece.chars().take_while(char::is_ascii_digit).collect();
                let number: u32 = digits.parse().unwrap();
                assert!(number <= most + 1, "${number} stands before ${} in\n{text}", most + 1);
                most = most.max(number);
            }
        }
    }

    #[test]
    fn nothing_is_left_of_what_the_engines_call_differently() {
        for text in SCHEMAS.into_iter().chain(ALL).chain([SCHEMA_VERSION]) {
            assert!(!for_sqlite(text).contains(['{', '}']), "{text}");
        }
    }
}
