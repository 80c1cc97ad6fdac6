//! The JSON documents that the program prints.

use std::sync::OnceLock;

use halfrow::report;
use halfrow::result::Report;
use jsonschema::Validator;
use serde_json::Value;

use super::held;

/// The schema in the repository.
pub const SCHEMA: &str = include_str!("../../../host/schema/halfrow-1.json");

/// Checks a document against the schema, and a report also against itself after it was read back.
///
/// # Panics
/// If either differs.
pub fn assert_valid(document: &Value) {
    static VALIDATOR: OnceLock<Validator> = OnceLock::new();
    let validator = VALIDATOR.get_or_init(|| {
        let schema = serde_json::from_str(SCHEMA).unwrap();
        jsonschema::validator_for(&schema).unwrap()
    });
    let wrong = held::errors(validator, document);
    assert!(wrong.is_empty(), "not as the schema says: {wrong:#?}");
    if !document["run"].is_null() {
        let report: Report = serde_json::from_value(document.clone()).unwrap();
        let again: Value = serde_json::from_str(&report::json(&report).unwrap()).unwrap();
        assert_eq!(&again, document);
    }
}

/// The result in one sentence: of a run, or of a call that was refused.
#[must_use]
pub fn headline(document: &Value) -> String {
    document["headline"].as_str().map_or_else(|| error_sentence(document), str::to_owned)
}

/// Why a document has no result, with the causes; empty if it has one.
#[must_use]
pub fn error_sentence(document: &Value) -> String {
    let error = &document["error"];
    let causes = error["causes"].as_array().into_iter().flatten();
    let messages = std::iter::once(error).chain(causes).filter_map(|problem| problem["message"].as_str());
    messages.collect::<Vec<_>>().join(": ")
}
