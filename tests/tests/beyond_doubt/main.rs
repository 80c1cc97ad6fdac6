//! FAIL is the board's fault beyond doubt, and ERROR no more frequent than it must be: sound boards behind links that stall,
//! lose, repeat and reorder, and boards that make wrong statements.

// clippy.toml allows it inside #[test] functions, but not in the functions that several tests call.
#![allow(clippy::unwrap_used, clippy::panic)]

mod answered_twice;
mod anywhere;
mod asked_again;
mod at_speed;
mod before_outages;
mod by_the_rules;
mod cables_in_the_rules;
mod capabilities;
mod careless;
mod conduct;
mod counters;
mod doubled;
mod each_rule;
mod echoes;
mod exercised;
mod floods;
mod framed;
mod kept_rows;
mod late_answers;
mod late_rows;
mod least_blanking;
mod left_tables;
mod lost_rows;
mod misplaced;
mod order_of_looks;
mod outages;
mod recordings;
mod refusals;
mod refused_later;
mod reopened;
mod rule_by_rule;
mod rules;
mod second_look;
mod seen_once;
mod seldom_asked;
mod session_rules;
mod silent;
mod skipped;
mod slow_clocks;
mod soak;
mod stale_packets;
mod stalls;
mod told_at_speed;
mod told_late;
mod told_request;
mod uncounted;
mod unkept_rules;
mod windows;
