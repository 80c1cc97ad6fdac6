//! Limits that no board can keep.

use halfrow_station::plan::JSON_SCHEMA;

use super::{WHOLE, as_json, load};

/// Nothing that is measured is below 0, and no sample leaves a board at the clock at which it came.
#[test]
fn what_every_board_is_beyond_is_no_limit() {
    let validator = jsonschema::validator_for(&serde_json::from_str(JSON_SCHEMA).unwrap()).unwrap();
    for (good, bad, expected) in [
        (
            "most = 1004",
            "most = -5",
            Some("plan.toml:39: latency.clocks is never at most -5; write a number above 0"),
        ),
        (
            "most = 1010",
            "most = 0",
            Some("plan.toml:44: latency.clocks is never at most 0; write a number above 0"),
        ),
        (
            "latency.clocks\" = { most = 1004",
            "latency.microseconds\" = { most = 0",
            Some("plan.toml:39: latency.mic"),
        ),
        (
            "most = 60",
            "most = -0.5",
            Some("plan.toml:41: run.seconds is never at most -0.5; write a number from 0 on"),
        ),
        ("most = 60", "most = 0", None),
        ("least = 1.1e6", "most = 0.0", None),
        ("most = 1004", "most = 0.5", None),
    ] {
        let text = WHOLE.replacen(good, bad, 1);
        assert_ne!(text, WHOLE, "{good}");
        let said = load(&text).map(drop);
        let is_expected = match (&said, expected) {
            (Err(said), Some(expected)) => said.starts_with(expected),
            (said, expected) => said.is_ok() && expected.is_none(),
        };
        assert!(is_expected, "{bad}: {said:?}");
        assert_eq!(validator.is_valid(&as_json(&text).unwrap()), expected.is_none(), "{bad} by the schema");
    }
}
