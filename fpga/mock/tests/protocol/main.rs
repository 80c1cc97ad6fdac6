//! The board against `protocol/WIRE.md`, rule by rule, through its bytes.

#![expect(clippy::panic, clippy::unwrap_used, reason = "a test helper that cannot go on fails the test")]

mod bench;
mod capabilities;
mod commits;
mod configuring;
mod credit;
mod damage;
mod echo;
mod frames;
#[path = "../board/golden_rows.rs"]
mod golden_rows;
mod loss;
mod lossy_link;
#[expect(dead_code, reason = "it was made for the tests of the board's parts")]
#[path = "../board/support.rs"]
mod material;
mod mock_only;
mod one_bank;
mod order;
mod playing;
mod random;
mod resets;
mod sessions;
mod silence;
mod status;
mod subject;
mod table_reads;
mod table_writes;
mod uploads;
