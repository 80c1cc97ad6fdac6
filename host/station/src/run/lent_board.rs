//! The board of a run, which may be lent by labgrid.

use std::path::Path;

use halfrow::verdict::StoppedBy;

use super::Order;
use crate::labgrid::{Held, LaneBoard, Place};
use crate::lane::supervisor::{Attendant, End, LaneReport, Patience, supervise};
use crate::lane::{Job, Message};
use crate::said::Said;

/// Has a lane carry out the job. If the board is at a place of labgrid, the place is held meanwhile.
pub(super) fn supervised(
    order: &Order<'_>,
    mut job: Job,
    spool: &Path,
    patience: Patience,
    attendant: &mut dyn Attendant,
) -> LaneReport {
    let place = match order.board {
        // The mock needs no board.
        LaneBoard::Lent(place) if !job.is_mock => place,
        _ => return supervise(order.program, &job, spool, patience, attendant),
    };
    match held(place, attendant) {
        Ok(held) => {
            job.target = held.target.to_string();
            tracing::info!("the place {} is {}", place.name, job.target);
            let heard = supervise(order.program, &job, spool, patience, attendant);
            held.give_back();
            heard
        }
        Err(end) => LaneReport { steps: Vec::new(), end },
    }
}

fn held(place: &Place, attendant: &mut dyn Attendant) -> Result<Held, End> {
    attendant.hear(&Message::Doing { what: format!("waiting for the place {}", place.name) });
    match place.hold(&|| attendant.stop().is_some()) {
        Ok(Some(held)) => Ok(held),
        Ok(None) => Err(End::Stopped(attendant.stop().unwrap_or(StoppedBy::System))),
        Err(error) => Err(End::Refused(Said::of(&error))),
    }
}
