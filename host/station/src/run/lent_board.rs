//! The board of a run, which may be lent by labgrid.

use std::path::Path;

use halfrow::verdict::StoppedBy;

use super::{Attending, Order, Stage, Watch};
use crate::labgrid::{AcquiredPlace, LaneBoard, Place};
use crate::lane::LaneJob;
use crate::lane::supervisor::{End, LaneReport, Patience, supervise};
use crate::said::Said;

/// Has a lane carry out the job. If the board is at a place of labgrid, the place is held meanwhile. Also returns why the place was
/// lost, if it is no longer held at the end.
pub(super) fn supervised(
    order: &Order<'_>,
    mut job: LaneJob,
    spool: &Path,
    patience: Patience,
    attending: &mut Attending<'_>,
) -> (LaneReport, Option<Said>) {
    // The mock needs no board.
    if let LaneBoard::Lent(place) = order.board
        && !job.is_mock
    {
        match held(place, attending.watch) {
            Ok(held) => {
                job.target = held.target.to_string();
                tracing::info!("the place {} is {}", place.name, job.target);
                attending.place = Some(held);
            }
            Err(end) => return (LaneReport { steps: Vec::new(), took: None, end }, None),
        }
    }
    let heard = supervise(order.program, &job, spool, patience, attending);
    let Some(mut held) = attending.place.take() else { return (heard, None) };
    let lost = if attending.watch.stop().is_none() { held.lost() } else { None };
    held.give_back();
    (heard, lost.map(|lost| Said::of(&lost)))
}

fn held(place: &Place, watch: &mut dyn Watch) -> Result<AcquiredPlace, End> {
    watch.hear(Stage::AwaitsPlace(&place.name));
    match place.hold(&|| watch.stop().is_some()) {
        Ok(Some(held)) => Ok(held),
        Ok(None) => Err(End::Stopped(watch.stop().unwrap_or(StoppedBy::System))),
        Err(error) => Err(End::Refused(Said::of(&error))),
    }
}
