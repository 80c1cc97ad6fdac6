//! Boards that do not begin with session 1.

use std::time::Duration;

use halfrow_conformance::{Boards, Build, HELLO, Subject, suite, wire};
use halfrow_protocol::message::Hello;
use halfrow_protocol::{Header, Kind, Request};

use crate::Mock;

/// Mocks whose next session is this one.
struct Beginning(u8);

impl Boards for Beginning {
    fn offers(&self, build: &Build) -> bool {
        Mock.offers(build)
    }

    fn switched_on(&self, build: &Build) -> Box<dyn Subject> {
        let mut board = Mock.switched_on(build);
        for session in 1..self.0 {
            let header =
                Header { kind: Kind::Hello.code(), sequence: 0, reply: false, session: 0, window: 0 };
            let hello = Request::Hello(Hello { nonce: session.into(), ..HELLO });
            board.answer(&wire(&header, |payload| hello.write(payload)), Duration::ZERO);
        }
        board
    }

    fn cases(&self) -> u32 {
        Mock.cases()
    }
}

/// The first session after power-up may have any number from 1 to 255 (WIRE.md, 2.2).
#[test]
fn tests_of_foreign_sessions_hold_whatever_the_first_one_is() {
    use suite::{sessions, silence, status};
    for first in [75, 99, 255] {
        let on = &Beginning(first);
        sessions::the_session_is_looked_at_before_kind_and_payload(on);
        sessions::a_foreign_acknowledgement_is_counted_and_not_answered(on);
        sessions::a_foreign_packet_is_not_carried_out(on);
        sessions::a_hello_that_names_a_session_is_answered_with_the_one_it_opens(on);
        sessions::sessions_are_counted_and_1_comes_behind_255(on);
        status::clearing_answers_with_the_counters_before_it_and_leaves_what_is_no_counter(on);
        silence::damaged_and_foreign_packets_do_not_count(on);
    }
}
