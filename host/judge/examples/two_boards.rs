//! Judges two mock boards at once, one of them broken, and keeps the results in a place of its own.

use std::error::Error;
use std::sync::mpsc::{self, Sender};
use std::thread;

use halfrow::frames::Builtin;
use halfrow::link;
use halfrow::model::{BitDepth, Equidistant, Geometry, Interpolant, TableSet};
use halfrow::{Event, FrameSource, Plan, ReportFolder, RunOptions, Verdict};

type Failure = Box<dyn Error + Send + Sync>;

// This is a program: it may print, which the libraries may not.
#[allow(clippy::print_stdout)]
fn main() -> Result<(), Failure> {
    let lens = Equidistant::from_radius(147.56)?;
    let geometry = Geometry::centred(256, 144, BitDepth::Twelve)?;
    let tables = TableSet::from_lens(geometry, &lens, None)?;
    let plan = Plan::new(tables, Interpolant::Hermite.into())
        .seen_through(lens)
        .frames([FrameSource::Builtin(Builtin::Street)]);
    let results = tempfile::tempdir()?;

    let judge = |name: &'static str, target: &str, watch: Sender<_>| -> Result<Verdict, Failure> {
        let told = move |event| _ = watch.send((name, event));
        let board = link::open(&target.parse()?)?;
        let folder = ReportFolder::prepare(&results.path().join(name), false)?;
        let mut finished = halfrow::verify(&plan, board, &RunOptions::default(), &told)?;
        finished.commit(folder)?;
        println!("{name}: {}", finished.report.headline());
        Ok(finished.report.verdict())
    };
    let verdicts = thread::scope(|scope| {
        let (sender, events) = mpsc::channel();
        let (judge, left, right) = (&judge, sender.clone(), sender);
        let sound = scope.spawn(move || judge("left", "mock", left));
        let broken = scope.spawn(move || judge("right", "mock,fault=stuck-data", right));
        // They end once both threads have let go of their senders, also if a board cannot be opened.
        for (name, event) in events {
            match event {
                Event::Step(step) => println!("{name}: {step}"),
                Event::Frame(frame) => println!("{name}: {frame}"),
                Event::AtSpeed(judged) => println!("{name}: {judged}"),
                _ => {}
            }
        }
        [sound.join(), broken.join()].map(|joined| joined.map_err(|_| "a run panicked")?)
    });
    let [sound, broken] = verdicts;
    assert_eq!((sound?, broken?), (Verdict::Pass, Verdict::Fail));
    assert!(results.path().join("right/report.html").is_file());
    Ok(())
}
