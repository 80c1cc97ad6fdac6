//! The plant's clock was ahead, and is set right while somebody has a board or a job. Nobody may be taken for gone by that, and
//! nobody who is gone may keep others waiting for as long as the clock was ahead.

use halfrow_station::store::{Plant, SharedBoard, Turn, Waiter};

use super::{board, shared, with_a_job, worker};
use crate::common::now_ms;
use crate::plant::server::Server;

/// Sets the server's clock this much ahead of the computer's own, for whoever connects after the first time.
fn ahead(server: &Server, seconds: u32) {
    let set = format!(
        "CREATE OR REPLACE FUNCTION public.clock_timestamp() RETURNS timestamptz LANGUAGE sql
            AS $$ SELECT pg_catalog.clock_timestamp() + interval '{seconds} s' $$;
        ALTER DATABASE plant SET search_path = public, pg_catalog"
    );
    server.client("plant").batch_execute(&set).unwrap();
}

fn waiter(name: &str) -> Waiter {
    Waiter::new("mock", name, "12", now_ms()).unwrap()
}

/// docs/plant.md: for 30 s, and a place in the queue for 10 s.
#[test]
fn a_board_is_lost_half_a_minute_after_the_clock_was_set_back_unless_it_is_renewed() {
    for is_renewed in [false, true] {
        let (server, _) = shared(1);
        ahead(&server, 3600);
        let mut plant = Plant::connect(&server.address()).unwrap();
        let Turn::Held(held) = plant.wait(&waiter("first")).unwrap() else { panic!("it is free") };
        assert_eq!(plant.wait(&waiter("gone")).unwrap(), Turn::Waits { before: 0 });
        ahead(&server, 0);
        let last = Waiter { id: id(), ..waiter("last") };
        assert_eq!(plant.wait(&last).unwrap(), Turn::Waits { before: 1 }, "it is held");
        ahead(&server, 12);
        if is_renewed {
            assert!(plant.renew(&held).unwrap());
        }
        assert_eq!(plant.wait(&last).unwrap(), Turn::Waits { before: 0 }, "it is held");
        ahead(&server, 31);
        let turn = plant.wait(&last).unwrap();
        assert_eq!(matches!(turn, Turn::Held(_)), !is_renewed, "{turn:?}");
        assert_eq!(plant.renew(&held).unwrap(), is_renewed);
    }
}

#[test]
fn a_job_is_lost_half_a_minute_after_the_clock_was_set_back_unless_it_is_renewed() {
    for is_renewed in [false, true] {
        let (server, _, _) = with_a_job();
        ahead(&server, 3600);
        let mut plant = Plant::connect(&server.address()).unwrap();
        let first = plant.claim(&worker("first")).unwrap().unwrap();
        ahead(&server, 0);
        assert_eq!(plant.claim(&worker("second")).unwrap(), None, "it is held");
        ahead(&server, 12);
        if is_renewed {
            assert!(plant.renew_claim(&first).unwrap());
        }
        assert_eq!(plant.claim(&worker("second")).unwrap(), None, "it is held");
        ahead(&server, 31);
        assert_eq!(plant.claim(&worker("second")).unwrap().is_some(), !is_renewed);
        assert_eq!(plant.renew_claim(&first).unwrap(), is_renewed);
    }
}

#[test]
fn a_board_can_be_shared_otherwise_half_a_minute_after_the_clock_was_set_back() {
    let (server, _) = shared(1);
    ahead(&server, 3600);
    let mut plant = Plant::connect(&server.address()).unwrap();
    assert!(matches!(plant.wait(&waiter("first")).unwrap(), Turn::Held(_)));
    ahead(&server, 0);
    let other = SharedBoard { target: "tcp:shelf:5000".to_owned(), ..board(0, "other") };
    assert!(!plant.share(&other, "engel").unwrap(), "somebody has it");
    ahead(&server, 31);
    assert!(plant.share(&other, "engel").unwrap());
}

/// An id behind those that were drawn while the clock was ahead.
fn id() -> String {
    crate::history::made::id(now_ms() + 7_200_000, 1)
}
