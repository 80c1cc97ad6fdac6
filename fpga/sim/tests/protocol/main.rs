//! The Verilog against `protocol/WIRE.md`, rule by rule, through its bytes: the tests of the mock, but for those in its
//! `mock_only.rs`. Beside every board stands the mock, which gets the same bytes and must answer the same.

#![expect(clippy::panic, clippy::unwrap_used, reason = "a test helper that cannot go on fails the test")]

mod judged;
mod subject;

#[path = "../../../mock/tests/protocol/bench.rs"]
mod bench;
#[path = "../../../mock/tests/protocol/capabilities.rs"]
mod capabilities;
#[path = "../../../mock/tests/protocol/commits.rs"]
mod commits;
#[path = "../../../mock/tests/protocol/configuring.rs"]
mod configuring;
#[path = "../../../mock/tests/protocol/credit.rs"]
mod credit;
#[path = "../../../mock/tests/protocol/damage.rs"]
mod damage;
#[path = "../../../mock/tests/protocol/echo.rs"]
mod echo;
#[path = "../../../mock/tests/protocol/frames.rs"]
mod frames;
#[path = "../../../mock/tests/board/golden_rows.rs"]
mod golden_rows;
#[path = "../../../mock/tests/protocol/loss.rs"]
mod loss;
#[path = "../../../mock/tests/protocol/lossy_link.rs"]
mod lossy_link;
#[expect(dead_code, reason = "it was made for the tests of the mock's parts")]
#[path = "../../../mock/tests/board/support.rs"]
mod material;
#[path = "../../../mock/tests/protocol/one_bank.rs"]
mod one_bank;
#[path = "../../../mock/tests/protocol/order.rs"]
mod order;
#[path = "../../../mock/tests/protocol/playing.rs"]
mod playing;
#[path = "../../../mock/tests/protocol/random.rs"]
mod random;
#[path = "../../../mock/tests/protocol/resets.rs"]
mod resets;
#[path = "../../../mock/tests/protocol/sessions.rs"]
mod sessions;
#[path = "../../../mock/tests/protocol/silence.rs"]
mod silence;
#[path = "../../../mock/tests/protocol/status.rs"]
mod status;
#[path = "../../../mock/tests/protocol/table_reads.rs"]
mod table_reads;
#[path = "../../../mock/tests/protocol/table_writes.rs"]
mod table_writes;
#[path = "../../../mock/tests/protocol/uploads.rs"]
mod uploads;
