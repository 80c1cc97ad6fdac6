//! The steps of a run, in their order.

use std::sync::mpsc::Receiver;
use std::thread;

use halfrow_model::{Kernel, TableSet, Taps};
use halfrow_protocol::message::BoardNature;

use super::findings::{End, Findings};
use super::golden;
use super::legal::impossible;
use super::patterns::patterns;
use super::plan::{Generation, Plan, Segment};
use super::prepared::{self, PrepareError, Prepared};
use super::reconnect::WayBack;
use crate::board::{Board, Capabilities};
use crate::progress::Progress;
use crate::reference;
use crate::tables::DATAPATH;
use crate::target::BoardKind;
use crate::verdict::Exit;

/// The largest L that a board may have.
pub(super) const MAX_LATENCY: u8 = 32;

/// A run with an open board.
pub(super) struct Run<'a> {
    pub(super) plan: &'a Plan,
    pub(super) board: &'a mut Board,
    pub(super) generations: Vec<Generation>,
    pub(super) way_back: &'a WayBack,
    pub(super) progress: &'a dyn Progress,
    pub(super) findings: &'a mut Findings,
}

pub(super) fn judge_the_judge(findings: &mut Findings) -> Result<(), End> {
    match golden::judge_the_judge() {
        Ok(samples) => {
            let detail = format!("this computer finds all {samples} golden samples ({})", reference::path());
            findings.passed("judge", detail);
            Ok(())
        }
        Err(what) => {
            let headline = format!(
                "this computer cannot judge: {what}; rebuild halfrow, and if that does not help, test the \
                 computer's memory"
            );
            Err(End::error("judge", Exit::Error, headline))
        }
    }
}

impl Run<'_> {
    /// All that needs an open board.
    pub(super) fn all_steps(&mut self) -> Result<(), End> {
        self.findings.note_identity(self.board);
        self.identity()?;
        match self.all_but_identity() {
            Err(failed @ End::Failed { .. }) => self.look_again(failed),
            ended => ended,
        }
    }

    /// From the link to the counters. Whatever the board held before is nothing to it.
    pub(super) fn all_but_identity(&mut self) -> Result<(), End> {
        let schedule = self.plan.schedule(self.board.capabilities.table_banks);
        let (plan, generations) = (self.plan, self.generations.clone());
        thread::scope(|scope| {
            let frames = prepared::ahead(scope, plan, &schedule, generations);
            self.progress.step("testing the link");
            self.persist(Self::link)?;
            let last = self.stream_all(&schedule, &frames)?;
            self.conclude(last)
        })
    }

    /// Streams the segments, up to the first that differs when that is asked for, and returns the last one streamed.
    fn stream_all<'s>(
        &mut self,
        schedule: &'s [Segment],
        source: &Receiver<Result<Prepared, PrepareError>>,
    ) -> Result<Option<&'s Segment>, End> {
        let height = self.plan.tables.geometry().height() as u64;
        let frames: usize = schedule.iter().map(|segment| segment.frames.len()).sum();
        self.progress.rows_expected(frames as u64 * height);
        for segment in schedule {
            if let Err(end) = self.prepare(segment) {
                self.return_to(segment, 0, end)?;
            }
            self.stream(segment, source)?;
            if self.plan.fail_fast && self.findings.seen.differences() > 0 {
                return Ok(Some(segment));
            }
        }
        Ok(schedule.last())
    }

    /// Judges what was seen, with the board back where it was after `last` if it goes away meanwhile.
    fn conclude(&mut self, last: Option<&Segment>) -> Result<(), End> {
        loop {
            match (self.judge(), last) {
                (Err(end), Some(last)) if end.is_outage() => self.return_to(last, last.frames.len(), end)?,
                (judged, _) => return judged,
            }
        }
    }

    fn identity(&mut self) -> Result<(), End> {
        let error = |exit, what| Err(End::error("identity", exit, what));
        let datapath = self.board.capabilities.datapath;
        if datapath != DATAPATH {
            return error(
                Exit::Refused,
                format!(
                    "the board computes datapath {datapath}, and this program judges datapath {DATAPATH}; load a \
                     bitstream of datapath {DATAPATH}, or install a halfrow that knows {datapath}"
                ),
            );
        }
        if let Some(impossible) = impossible(&self.board.capabilities) {
            return error(Exit::Refused, impossible);
        }
        if self.plan.require_hardware && self.findings.board.kind != BoardKind::Hardware {
            return error(
                Exit::NothingJudged,
                "hardware is required and this is none, so nothing was judged; name a real board with --board"
                    .to_owned(),
            );
        }
        if let Some(misfit) = misfit(&self.plan.tables, &self.plan.kernel, &self.board.capabilities) {
            return error(Exit::Usage, misfit);
        }
        let detail = format!(
            "{}, wire {}, datapath {DATAPATH}",
            self.board.capabilities.name, self.board.welcome.version
        );
        self.findings.passed("identity", detail);
        Ok(())
    }

    fn link(&mut self) -> Result<(), End> {
        let board_error = |error| End::board("link", &error);
        let (_, round_trip) = self.board.echo(&[]).map_err(board_error)?;
        self.findings.link.round_trip_us = Some(round_trip.as_micros() as u64);
        let patterns = patterns(self.plan.seed);
        let bytes: usize = patterns.iter().map(Vec::len).sum();
        for pattern in &patterns {
            let (same, _) = self.board.echo(pattern).map_err(board_error)?;
            if !same {
                return Err(End::failed(
                    "link",
                    "the board returns other bytes than it was sent, under a CRC that it computed itself"
                        .to_owned(),
                    "Check the board's packet buffers: the link carried what the board sent.",
                ));
            }
        }
        self.board.start_afresh().map_err(board_error)?;
        let detail = format!("{bytes} bytes in {} echoes came back as they went", patterns.len());
        self.findings.passed("link", detail);
        Ok(())
    }
}

/// Why a board with these capabilities cannot have the tables and the kernel, if it cannot.
#[must_use]
pub fn misfit(tables: &TableSet, kernel: &Kernel, capabilities: &Capabilities) -> Option<String> {
    let geometry = tables.geometry();
    let (width, height) = (usize::from(capabilities.max_width), usize::from(capabilities.max_height));
    if geometry.width() > width || geometry.height() > height {
        let (columns, rows) = (geometry.width(), geometry.height());
        let mut remedy = "use smaller frames and tables".to_owned();
        if capabilities.nature == BoardNature::Mock {
            remedy = format!("{remedy}, or a mock that takes these: --board mock,max-width={columns}");
            if rows > height {
                remedy = format!("{remedy},max-height={rows}");
            }
        }
        return Some(format!(
            "frames of {columns} x {rows} do not fit the board, which takes {width} x {height} at most; {remedy}"
        ));
    }
    let bits = geometry.depth().bits();
    if !capabilities.sample_depths().has(bits as u8) {
        return Some(format!("the board has no {bits}-bit samples; use tables of another depth"));
    }
    if kernel.taps() == Taps::Seven && capabilities.taps < 7 {
        return Some(
            "the kernel needs seven taps and the board has five; use a five-tap kernel such as hermite"
                .to_owned(),
        );
    }
    tables.check_ring(usize::from(capabilities.ring)).err().map(|error| error.to_string())
}
