//! Boards that are sound except for one rule, which only a request breaks that no host makes.

use halfrow::board::RefusalCode;
use halfrow::result::Rule;
use halfrow_protocol::message::Refusal;
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::Passing;

use super::rule_by_rule::answering;
use super::rules::broken;

#[test]
fn the_port_of_a_write_is_not_looked_at() {
    let refusal = Refusal { code: RefusalCode::Range, kind: Kind::TableWrite.code(), detail: 0 };
    let refused = move |packet: Passing| packet.saying(&Reply::Refusal(refusal));
    let report = answering(Kind::TableWrite, |payload| payload.get(2) > Some(&1), refused);
    assert_eq!(broken(&report).0, Rule::Address);
}
