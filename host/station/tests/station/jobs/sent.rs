//! What the plant does with the run of a job.

use std::cell::Cell;
use std::sync::mpsc;

use halfrow::Verdict;
use halfrow::verdict::StoppedBy;
use halfrow_station::outbox::{Outbox, PlantSink, Sink, Undelivered};
use halfrow_station::plan::Plan;
use halfrow_station::run::Stage;
use halfrow_station::said::{Said, Saying};
use halfrow_station::settings::Settings;
use halfrow_station::store::{Parcel, SINK_OF_PLANT};

use super::shift::{checked, good, prepared};
use super::{at_work, job, judged, plan, settings, shared, with_a_job};
use crate::common::{engel, folder, program, reason};

/// Whether the plant has the run of a job by this plan, and whether the run counts there and is superseded, if the outbox `sends`,
/// and if a person cancels the job while the result is being saved.
fn became(plan: &Plan, sends: bool, is_cancelled: bool) -> (bool, Option<bool>, Option<bool>) {
    let (server, mut plant) = shared(1);
    let id = plant.add_jobs(&job(plan, &good()), 1).unwrap().remove(0);
    let folder = folder();
    let settings = Settings::load_without_lanes(&prepared(&server, folder.path(), plan)).unwrap();
    let work = at_work(&settings, program().to_owned());
    let (origin, kept) = work.store.with(|store| (store.origin().unwrap(), store.folder().clone()));
    let sink = PlantSink::new(server.address(), settings.introduction(origin), kept);
    let sinks: Vec<Box<dyn Sink>> = if sends { vec![Box::new(sink)] } else { Vec::new() };
    let outbox = Outbox::start(&work.store, sinks).unwrap();
    let claim = work.claim().unwrap().unwrap();
    let is_over = Cell::new(false);
    let stop = || is_over.get().then_some(StoppedBy::Person);
    let mut heard = |stage: Stage<'_>| {
        if matches!(stage, Stage::Saving { .. }) {
            is_over.set(!sends);
            assert!(!is_cancelled || plant.cancel_job(&id, engel(&reason("a mistake"))).unwrap());
        }
    };
    let judged = work.judge(claim, &stop, &stop, &mut heard).unwrap();
    outbox.close();
    assert_eq!(judged.saved.record.conclusion.verdict, Verdict::Pass);
    (judged.is_sent, judged.counts, judged.is_superseded)
}

#[test]
fn whether_a_run_counts_is_told_once_the_plant_has_it() {
    let became = |sends, is_cancelled| became(&plan(), sends, is_cancelled);
    assert_eq!(became(true, false), (true, Some(true), Some(false)));
    assert_eq!(became(true, true), (true, Some(false), Some(true)), "its job was cancelled");
    assert_eq!(became(false, false), (false, None, None), "nobody knows yet");
}

#[test]
fn whether_a_job_was_cancelled_is_told_of_a_unit_that_checks_shifts_too() {
    let became = |is_cancelled| became(&checked("allow"), true, is_cancelled);
    assert_eq!(became(false), (true, Some(false), Some(false)));
    assert_eq!(became(true), (true, Some(false), Some(true)));
}

/// A plant that has what it is given before the outbox hears of that.
struct Late {
    plant: PlantSink,
    told: mpsc::Receiver<()>,
}

impl Sink for Late {
    fn name(&self) -> &str {
        self.plant.name()
    }

    fn take(&mut self, parcel: &Parcel) -> Result<(), Undelivered> {
        self.plant.take(parcel)?;
        // Its end is what tells.
        let _ = self.told.recv();
        Ok(())
    }
}

/// The plant ends a job as it takes its run, so that the next renewal finds no job, perhaps before the outbox has noted the run.
#[test]
fn a_job_that_ended_with_its_run_is_not_taken_for_one_that_was_lost() {
    let (server, ..) = with_a_job();
    let folder = folder();
    let settings = Settings::load_without_lanes(&settings(&server, folder.path(), "12")).unwrap();
    let work = at_work(&settings, program().to_owned());
    let (origin, kept) = work.store.with(|store| (store.origin().unwrap(), store.folder().clone()));
    let plant = PlantSink::new(server.address(), settings.introduction(origin), kept);
    let (tells, told) = mpsc::channel();
    let outbox = Outbox::start(&work.store, vec![Box::new(Late { plant, told })]).unwrap();
    let judged = judged(&work);
    drop(tells);
    outbox.close();
    assert_eq!((judged.is_sent, judged.counts, judged.refused), (true, Some(true), None));
}

/// A plant that answers, but accepts nothing.
struct Refusing;

impl Sink for Refusing {
    fn name(&self) -> &str {
        SINK_OF_PLANT
    }

    fn take(&mut self, _: &Parcel) -> Result<(), Undelivered> {
        Err(Undelivered::Refused(Saying::PlanChanged.into()))
    }
}

#[test]
fn what_the_plant_does_not_take_holds_no_board_and_says_why() {
    let (server, ..) = with_a_job();
    let folder = folder();
    let settings = Settings::load_without_lanes(&settings(&server, folder.path(), "12")).unwrap();
    let work = at_work(&settings, program().to_owned());
    let outbox = Outbox::start(&work.store, vec![Box::new(Refusing)]).unwrap();
    let judged = judged(&work);
    outbox.close();
    assert_eq!(judged.saved.record.conclusion.verdict, Verdict::Pass, "it is kept");
    assert_eq!((judged.is_sent, judged.counts), (false, None));
    assert_eq!(judged.refused, Some(Said::from(Saying::PlanChanged).to_string()));
    assert_eq!(server.rows("SELECT count(*) FROM board WHERE holder IS NOT NULL"), [["0"]]);
}
