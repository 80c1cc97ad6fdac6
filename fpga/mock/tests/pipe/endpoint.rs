//! A board other than the mock at the end of the wire.

use std::time::Duration;

use halfrow_pipe::{Broken, Endpoint, PipeSetup};

/// Sends back what it gets, and stops at an `x`.
#[derive(Default)]
struct Echo {
    outgoing: Vec<u8>,
}

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("an x came")]
struct Stopped;

impl Endpoint for Echo {
    type Failure = Stopped;

    fn receive(&mut self, bytes: &[u8], _: Duration) -> Result<(), Stopped> {
        self.outgoing.extend_from_slice(bytes);
        if bytes.contains(&b'x') { Err(Stopped) } else { Ok(()) }
    }

    fn outgoing(&mut self) -> &mut Vec<u8> {
        &mut self.outgoing
    }
}

#[test]
fn a_board_that_stops_breaks_the_wire_once_what_it_said_has_arrived() {
    let mut wire = PipeSetup::from_options(&[]).unwrap().connect(Echo::default());
    let mut incoming = Vec::new();
    assert_eq!(wire.exchange(b"ab", &mut incoming, Duration::ZERO), Ok(2));
    assert_eq!(wire.exchange(b"xc", &mut incoming, Duration::ZERO), Ok(2));
    assert_eq!(incoming, b"abxc");
    let stopped = Broken::Board { at: Duration::ZERO, failure: Stopped };
    assert_eq!(wire.exchange(b"d", &mut incoming, Duration::ZERO), Err(stopped));
}
