//! The board of a run, which may be lent by labgrid.

use std::cell::RefCell;
use std::path::Path;

use halfrow::verdict::StoppedBy;

use super::Order;
use crate::labgrid::{AcquiredPlace, LaneBoard, Place};
use crate::lane::supervisor::{Attendant, End, LaneReport, Patience, supervise};
use crate::lane::{Job, Message, Ruling};
use crate::record::BoardSeen;
use crate::said::Said;

/// Has a lane carry out the job. If the board is at a place of labgrid, the place is held meanwhile. Also returns why the place was
/// lost, if it is no longer held at the end.
pub(super) fn supervised(
    order: &Order<'_>,
    mut job: Job,
    spool: &Path,
    patience: Patience,
    attendant: &mut dyn Attendant,
) -> (LaneReport, Option<Said>) {
    let place = match order.board {
        // The mock needs no board.
        LaneBoard::Lent(place) if !job.is_mock => place,
        _ => return (supervise(order.program, &job, spool, patience, attendant), None),
    };
    match held(place, attendant) {
        Ok(held) => {
            job.target = held.target.to_string();
            tracing::info!("the place {} is {}", place.name, job.target);
            let mut lent = Lent { held: RefCell::new(held), attendant };
            let heard = supervise(order.program, &job, spool, patience, &mut lent);
            let lost = if lent.attendant.stop().is_none() { lent.held.get_mut().lost() } else { None };
            lent.held.into_inner().give_back();
            (heard, lost.map(|lost| Said::of(&lost)))
        }
        Err(end) => (LaneReport { steps: Vec::new(), took: None, end }, None),
    }
}

fn held(place: &Place, attendant: &mut dyn Attendant) -> Result<AcquiredPlace, End> {
    attendant.hear(&Message::Doing { what: format!("waiting for the place {}", place.name) });
    match place.hold(&|| attendant.stop().is_some()) {
        Ok(Some(held)) => Ok(held),
        Ok(None) => Err(End::Stopped(attendant.stop().unwrap_or(StoppedBy::System))),
        Err(error) => Err(End::Refused(Said::of(&error))),
    }
}

/// Ends the run when the place is lost.
struct Lent<'a> {
    held: RefCell<AcquiredPlace>,
    attendant: &'a mut dyn Attendant,
}

impl Attendant for Lent<'_> {
    fn stop(&self) -> Option<StoppedBy> {
        let is_lost = || self.held.borrow_mut().lost().is_some();
        self.attendant.stop().or_else(|| is_lost().then_some(StoppedBy::Caller))
    }

    fn hear(&mut self, message: &Message) {
        self.attendant.hear(message);
    }

    fn rule(&mut self, board: &BoardSeen) -> Ruling {
        self.attendant.rule(board)
    }
}
