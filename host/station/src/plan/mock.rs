//! The mock board with a drawn fault, in place of a unit that is known to be bad.
//!
//! It shows that the station and its plan tell a bad board from a good one. It shows nothing about the fixture, the
//! cable or the lane's board.

use halfrow::model::TableSet;

use super::serial::RESERVED;
use super::{Selected, StepKind};

/// What stands for it in a plan, and the barcode that has a lane judge it.
pub(crate) const BARCODE: &str = "HR:MOCK";

/// The most columns of a frame, and entries of a grid, that a mock board takes unless its target says otherwise.
const DEFAULT: usize = 2048;

/// Faults of the datapath that even the fewest frames of a plan show, whatever is drawn, each with its parameters; not
/// all that the mock has. Bits are flipped hidden, because a board that notices a flipped bit refuses its tables, and
/// no row is lost, because that stops a link test: both would be ERROR. The low bits of a factor are left out, because
/// they may change no sample.
const FAULTS: [(&str, &[(&str, Values)]); 6] = [
    ("stuck-data", &[("bit", Values::From(0, 7)), ("value", Values::From(0, 1))]),
    ("dead-tap", &[("tap", Values::From(0, 6))]),
    ("row-factor,hidden=true", &[("row", Values::Entry), ("bit", Values::From(10, 23))]),
    ("kernel-word,hidden=true", &[("node", Values::From(0, 64)), ("bit", Values::From(8, 14))]),
    ("tap-offset", &[("columns", Values::Word(&["-3", "-2", "-1", "1", "2", "3"]))]),
    ("no-rounding", &[]),
];

/// The values of a parameter.
#[derive(Clone, Copy)]
enum Values {
    /// Whole numbers from the first to the second.
    From(u64, u64),
    /// An entry of the row table or the grid.
    Entry,
    /// One of these.
    Word(&'static [&'static str]),
}

/// Whether a serial number is that of the mock in a lane. No board has it.
#[must_use]
pub fn is_mock(serial: &str) -> bool {
    serial.strip_prefix(BARCODE).is_some_and(|rest| rest.starts_with(':'))
}

/// Its serial number in this lane, so that several lanes may be checked at once.
#[must_use]
pub fn serial(lane: &str) -> String {
    debug_assert!(BARCODE.starts_with(RESERVED));
    format!("{BARCODE}:{lane}")
}

/// All tables by which `selected` judges.
fn tables(selected: &Selected) -> impl Iterator<Item = &TableSet> {
    selected.steps.iter().filter_map(|step| match &step.kind {
        StepKind::Verify(judging) => Some(&judging.chosen.tables),
        StepKind::Identity | StepKind::Link { .. } => None,
    })
}

/// The options of a mock board that takes these tables, as far as it does not by default. No frame has too many rows.
fn room(selected: &Selected) -> String {
    let width = tables(selected).map(|tables| tables.geometry().width()).max();
    let entries =
        tables(selected).filter(|tables| tables.shape().is_some()).map(|tables| tables.entries().len()).max();
    let option = |key, needed: Option<usize>| {
        needed
            .filter(|needed| *needed > DEFAULT)
            .map_or_else(String::new, |needed| format!(",{key}={needed}"))
    };
    option("max-width", width) + &option("entries", entries)
}

/// The target string of a mock board with a fault drawn by `seed`, which steps of `selected` can find.
#[must_use]
pub fn target(seed: u64, selected: &Selected) -> String {
    let mut drawn = Drawn(seed);
    // A coarse grid has fewer entries than its frame has rows.
    let entries = tables(selected).map(|tables| tables.entries().len().min(tables.geometry().height()));
    let entries = entries.min().unwrap_or(1) as u64;
    let Some((name, parameters)) = FAULTS.get(drawn.below(FAULTS.len() as u64) as usize) else {
        return "mock".to_owned();
    };
    let mut value = |values| match values {
        Values::From(least, most) => (least + drawn.below(most - least + 1)).to_string(),
        Values::Entry => drawn.below(entries).to_string(),
        Values::Word(words) => {
            words.get(drawn.below(words.len() as u64) as usize).copied().unwrap_or_default().to_owned()
        }
    };
    let parameters: String =
        parameters.iter().map(|(key, values)| format!(",{key}={}", value(*values))).collect();
    format!("mock{},fault={name}{parameters}", room(selected))
}

/// What is left of a seed from which numbers are drawn.
struct Drawn(u64);

impl Drawn {
    /// A number below `most`, which is at least 1.
    fn below(&mut self, most: u64) -> u64 {
        let drawn = self.0 % most.max(1);
        self.0 /= most.max(1);
        drawn
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::fs;

    use super::*;
    use crate::plan::Plan;

    /// The catalogue of faults is the mock's own.
    #[test]
    fn every_fault_that_may_be_drawn_is_one_of_the_mock() {
        let text = include_str!("../../assets/demo-plan.toml").to_owned();
        let plan = Plan::parse("plan.toml".as_ref(), text).unwrap();
        let targets: BTreeSet<_> = (0..4000).map(|seed| target(seed * 7919, plan.variant(""))).collect();
        let names: BTreeSet<_> = targets.iter().map(|target| target.split(',').nth(1).unwrap()).collect();
        assert_eq!(names.len(), FAULTS.len(), "{names:?}");
        assert!(targets.len() > 300, "{}", targets.len());
        for target in targets {
            halfrow::link::open(&target.parse().unwrap()).unwrap();
        }
    }

    /// A frame of 2592 columns, and a grid with more entries than a bank has by default (fpga/DATAPATH.md).
    #[test]
    fn the_mock_has_room_for_whatever_the_plan_judges() {
        use halfrow::model::{BitDepth, Geometry, GridShape, Interpolant, TableSet};
        let folder = tempfile::tempdir().unwrap();
        let tall = Geometry::centred(64, 2048, BitDepth::Ten).unwrap();
        let shape = GridShape::new(1, 5).unwrap();
        let tables = TableSet::from_grid(tall, shape, &vec![1 << 24; shape.entries(&tall)]).unwrap();
        let file = halfrow::tables::TableFile { tables, kernel: Interpolant::Hermite.into(), about: None };
        fs::write(folder.path().join("grid.json"), file.to_json()).unwrap();
        let usual = "radius = 200.0\nwidth = 320\nheight = 240";
        for tables in ["width = 2592\nheight = 8", "file = \"grid.json\""] {
            let text = include_str!("../../assets/demo-plan.toml").replace(usual, tables);
            let text = text.replace(", \"builtin:street\"", "");
            let plan = Plan::parse(&folder.path().join("plan.toml"), text).unwrap();
            let selected = plan.variant("");
            let StepKind::Verify(judging) = &selected.steps[1].kind else { panic!("{selected:?}") };
            // The first seed draws a bit of the data that is stuck, which every frame shows.
            let target: halfrow::target::Target = target(0, selected).parse().unwrap();
            let candidate = halfrow::link::open(&target).unwrap();
            let options = halfrow::RunOptions::default();
            let judged = halfrow::verify(&judging.plan(0), candidate, &options, &halfrow::progress::Silent);
            let verdict = judged.map(|judged| judged.report.verdict());
            assert_eq!(verdict, Ok(halfrow::Verdict::Fail), "{target}");
        }
    }

    #[test]
    fn no_board_has_its_serial_number() {
        assert!(is_mock(&serial("1")) && !is_mock(BARCODE) && !is_mock("HR:MOCKER:1"));
        assert!(serial("1").starts_with(RESERVED));
    }
}
