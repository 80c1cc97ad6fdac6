//! How long the parts of a run take on a link, in seconds: their prices.

use std::time::Duration;

use halfrow_model::MAX_WIDTH;
use halfrow_protocol::message::{Commit, Grids, RowIn, RowOut, Span};
use halfrow_protocol::{MAX_PAYLOAD, wire_length};
use serde::{Deserialize, Serialize};

use super::parts::{Part, Selection, parts_of};
use super::patterns::patterns;
use super::variations::Build;
use super::{AtSpeed, Plan, SENSOR_BLANKING, Segment, Timing};
use crate::board::{Board, BoardError, BoardNature, Bursts, Capabilities, Table, row_blanking};
use crate::run::{at_speed, rules};
use crate::tables::datapath_of;

/// The least payload that a row is priced at: between shorter rows the link stands still while they are acknowledged.
const SMALL: usize = 300;
/// Bytes that a link is taken to hand over at once: rows of which several fit into them are seen, and acknowledged, together.
const AT_ONCE: usize = 512;
/// The longest payload of requests and replies that carry neither rows nor tables.
const SHORT: usize = 64;
/// The payload of the reply to CAPABILITIES, with the board's name.
const CAPABILITIES: usize = 320;
/// Clocks that a commit of the longest tables takes (WIRE.md, "Reply times").
const COMMIT: usize = 28_000;
/// Round trips that are measured.
const ROUND_TRIPS: u32 = 3;
/// For how long the longest packets are sent and returned where a link does not know its speed, and how many at most, since a
/// virtual clock may stand still.
const LONG_LOOK: Duration = Duration::from_millis(100);
const LONG_LOOKS: u32 = 16;

/// How fast a link is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rates {
    /// Bytes a second each way.
    pub bytes_per_second: f64,
    /// From a short request to its answer, in seconds, without the time of the bytes.
    pub round_trip: f64,
}

impl Rates {
    /// The rates of the link to `board`, from a short measurement: the longest of a few round trips and, if the link does
    /// not know its speed, what the longest packets take.
    ///
    /// # Errors
    /// [`BoardError`] when an answer does not come.
    pub fn of(board: &mut Board) -> Result<Self, BoardError> {
        let short = round_trips(board, &[])?;
        let bytes_per_second = match board.bytes_per_second() {
            Some(known) => known,
            None => carried(short.0, long_round_trip(board)?),
        };
        let round_trip = short.1 - 2.0 * wire_length(0) as f64 / bytes_per_second;
        Ok(Self { bytes_per_second, round_trip: round_trip.max(0.0) })
    }

    /// The time in seconds of a request with a payload of `out` bytes and a reply with one of `back`.
    pub(crate) fn request(&self, out: usize, back: usize) -> f64 {
        self.round_trip + (wire_length(out) + wire_length(back)) as f64 / self.bytes_per_second
    }
}

/// The shortest and the longest of a few round trips of `bytes`, in seconds.
fn round_trips(board: &mut Board, bytes: &[u8]) -> Result<(f64, f64), BoardError> {
    let (mut shortest, mut longest) = (Duration::MAX, Duration::ZERO);
    for _ in 0..ROUND_TRIPS {
        let (_, took) = board.echo(bytes)?;
        (shortest, longest) = (shortest.min(took), longest.max(took));
    }
    Ok((shortest.as_secs_f64(), longest.as_secs_f64()))
}

/// The average time of a round trip of the longest packet, in seconds.
fn long_round_trip(board: &mut Board) -> Result<f64, BoardError> {
    let (mut took, mut looks) = (Duration::ZERO, 0);
    while took < LONG_LOOK && looks < LONG_LOOKS {
        took += board.echo(&[0; MAX_PAYLOAD])?.1;
        looks += 1;
    }
    Ok(took.as_secs_f64() / f64::from(looks))
}

/// The bytes a second of a link over which the shortest packet takes `short` seconds and the longest one `long`, there and then
/// back. If chance hides the difference, all of `long` counts, and the link is faster than the result.
fn carried(short: f64, long: f64) -> f64 {
    let took = if long > short { long - short } else { long };
    // A link that carries everything at once takes no time for any byte.
    if took > 0.0 { 2.0 * (wire_length(MAX_PAYLOAD) - wire_length(0)) as f64 / took } else { f64::INFINITY }
}

/// The prices of a plan's parts on a board.
#[derive(Debug)]
pub struct Prices<'a> {
    pub(crate) plan: &'a Plan,
    pub(crate) capabilities: &'a Capabilities,
    pub(crate) rates: Rates,
    whole: Vec<Segment>,
    corners: f64,
}

impl<'a> Prices<'a> {
    /// The prices on a board with these `capabilities`, over a link with these `rates`.
    #[must_use]
    pub fn new(plan: &'a Plan, capabilities: &'a Capabilities, rates: Rates) -> Self {
        let whole = plan.whole_schedule(&Build::of(capabilities));
        let prices = Self { plan, capabilities, rates, whole, corners: 0.0 };
        let corners = at_speed::price_of_corners(&prices);
        Self { corners, ..prices }
    }

    /// Every part that the plan has on this board.
    #[must_use]
    pub fn parts(&self) -> Vec<Part> {
        parts_of(&self.whole)
            .into_iter()
            .filter(|part| self.has_bursts() || !matches!(part, Part::AtSpeed | Part::Corners))
            .collect()
    }

    fn has_bursts(&self) -> bool {
        self.plan.at_speed != AtSpeed::Off && at_speed::known_bursts(self.capabilities).is_ok()
    }

    /// The most of `part`: rows, frames at speed, or 1.
    #[must_use]
    pub fn most(&self, part: Part) -> usize {
        match part {
            Part::AtSpeed => at_speed::most_frames(self),
            Part::Corners | Part::Rules => 1,
            _ => self.plan.tables.geometry().height(),
        }
    }

    /// How long a run of `selection` takes from the link test on, in seconds.
    #[must_use]
    pub fn seconds(&self, selection: &Selection) -> f64 {
        let rules = if selection.amount(Part::Rules) > 0 { rules::price(self) } else { 0.0 };
        self.every_run() + self.streamed(selection) + self.at_speed(selection) + rules
    }

    /// How long it would take at the usual pixel clock, whatever clock the board names, in seconds.
    pub(crate) fn at_the_usual_clock(&self, selection: &Selection) -> f64 {
        let capabilities = Capabilities { clock_hz: at_speed::USUAL_CLOCK, ..self.capabilities.clone() };
        Prices::new(self.plan, &capabilities, self.rates).seconds(selection)
    }

    /// The pixel clock that the board names, in hertz; none if it names none.
    pub(crate) fn named_clock(&self) -> Option<u32> {
        Some(self.capabilities.clock_hz).filter(|&clock_hz| clock_hz != 0)
    }

    /// What all of `part`, with what the part needs, adds to the shortest run, in seconds.
    #[must_use]
    pub fn of_part(&self, part: Part) -> f64 {
        let least = Selection::least();
        self.seconds(&least.with(part, self.most(part))) - self.seconds(&least)
    }

    /// The time of HELLO and CAPABILITIES, which are over before anything can be chosen, in seconds.
    #[must_use]
    pub fn opening(&self) -> f64 {
        self.short_request() + self.rates.request(0, CAPABILITIES)
    }

    /// The link test, the counters before and after all rows, and the end of the session.
    fn every_run(&self) -> f64 {
        let echoes = patterns(self.plan.seed).into_iter().map(|bytes| bytes.len());
        echoes.map(|bytes| self.rates.request(bytes, bytes)).sum::<f64>() + 5.0 * self.short_request()
    }

    fn streamed(&self, selection: &Selection) -> f64 {
        let segments = self.plan.streamable(selection).cut(self.whole.clone());
        segments.iter().map(|segment| self.segment(segment)).sum::<f64>() + self.read_back()
    }

    fn segment(&self, segment: &Segment) -> f64 {
        let rows = segment.rows();
        let width = segment.geometry.width();
        let least = row_blanking(self.capabilities, width, datapath_of(&self.plan.tables));
        let between = match segment.timing {
            Timing::Least => least.into(),
            Timing::Sensor => SENSOR_BLANKING.max(least).into(),
            // One clock in eight is off, and up to 15 are added between two rows.
            Timing::Gaps(_) => usize::from(least) + 15 + width.div_ceil(8),
        };
        let before = if segment.is_varied() { self.read_back() } else { 0.0 };
        let tables = segment.commit.map_or(0.0, |_| self.upload() + self.commit());
        before + tables + self.short_request() + self.rows(rows, width, between)
    }

    /// `rows` rows that follow each other. The slowest of way out, pixel clock and way back counts or, where answers take
    /// long, how many rows the board's banks hold meanwhile: rows that the host sees together leave the link still until they
    /// have come and others have gone out. The first two rows go out before anything comes back,
    /// because a row leaves while the next one enters. After the last one the board is asked what reached it.
    pub(crate) fn rows(&self, rows: usize, width: usize, between: usize) -> f64 {
        let packed = (3 * width).div_ceil(2);
        let returned = RowOut::HEAD + packed + RowOut::ENTERED;
        let carried = |payload| wire_length(payload) as f64 / self.rates.bytes_per_second;
        let (out, back) = (carried(RowIn::HEAD + packed), carried(returned.max(SMALL)));
        let played = self.clocks(width + between);
        let alone = 2.0 * (out + played) + self.rates.round_trip;
        // One bank has the row that only the next one pushes out.
        let banks = self.capabilities.row_banks_in.min(self.capabilities.row_banks_out).saturating_sub(1);
        let banks = banks.max(1);
        let at_once = (AT_ONCE / wire_length(returned)).clamp(1, banks.into()) as f64;
        let in_banks = self.rates.round_trip + at_once * (out + carried(returned)) + 2.0 * played;
        let slowest = back.max(played).max(in_banks / f64::from(banks));
        alone + rows as f64 * slowest + self.short_request()
    }

    /// Writing the plan's tables and reading them back.
    pub(crate) fn upload(&self) -> f64 {
        self.upload_of(self.plan.tables.entries().len())
    }

    /// Writing tables of so many row factors or entries of a grid, and reading them back.
    pub(crate) fn upload_of(&self, entries: usize) -> f64 {
        let written = [(Table::RowFactors, entries), (Table::Kernel, halfrow_model::NODES)];
        let write = |(table, entries): (Table, usize)| {
            let at_once = Board::entries_at_once(table);
            let packets = (0..entries).step_by(at_once).map(|first| at_once.min(entries - first));
            packets.map(|count| self.rates.request(Span::BYTES + count * table.entry_bytes(), 0)).sum::<f64>()
        };
        written.into_iter().map(write).sum::<f64>() + self.read_back()
    }

    /// Asking for the CRCs of both tables through every port.
    fn read_back(&self) -> f64 {
        let Capabilities { step_ports, kernel_ports, max_height, .. } = self.capabilities;
        let ports = f64::from(*step_ports) + f64::from(*kernel_ports);
        ports * (self.rates.request(Span::BYTES, 4) + self.clocks(4 * usize::from(*max_height)))
    }

    /// A commit, for which the board reads both tables through every port.
    pub(crate) fn commit(&self) -> f64 {
        self.rates.request(Commit::BYTES, 1) + self.clocks(COMMIT)
    }

    pub(crate) fn short_request(&self) -> f64 {
        self.rates.request(SHORT, SHORT)
    }

    fn clocks(&self, clocks: usize) -> f64 {
        clocks as f64 / f64::from(at_speed::clock_hz(self.capabilities))
    }

    fn at_speed(&self, selection: &Selection) -> f64 {
        let frames = selection.amount(Part::AtSpeed).min(self.most(Part::AtSpeed));
        if frames == 0 || !self.has_bursts() {
            return 0.0;
        }
        let corners = if selection.amount(Part::Corners) > 0 { self.corners } else { 0.0 };
        at_speed::price_of_frames(self, frames as u32) + corners
    }
}

/// What is assumed of a board that was not asked: that it has everything, for rows as wide as those of `plan`, or 1920 if these
/// are narrower.
#[must_use]
pub fn usual_capabilities(plan: &Plan, nature: BoardNature) -> Capabilities {
    let geometry = plan.tables.geometry();
    let build = Build::full(geometry.width().max(1920));
    Capabilities {
        datapath: crate::tables::DATAPATH.id(),
        max_width: build.ring.min(MAX_WIDTH) as u16,
        max_height: geometry.height().max(2048) as u16,
        depths: 7,
        taps: build.taps,
        latency: 12,
        ring: build.ring as u16,
        least_blanking: 0,
        table_banks: build.table_banks,
        row_banks_in: 4,
        row_banks_out: 4,
        step_ports: 1,
        kernel_ports: 2,
        clock_source: 0,
        clock_hz: 0,
        bursts: Some(Bursts { content: at_speed::CONTENT, records: 64, least_frame_blanking: 8, trap: true }),
        entered: true,
        grids: Some(Grids {
            further_datapath: 2,
            entries: 2048,
            ks: 1 << 5 | 1 << 6,
            grid_blanking: 32,
            grid_width: 144,
        }),
        nature,
        name: String::new(),
    }
}

#[cfg(test)]
mod tests {
    use halfrow_model::{BitDepth, Equidistant, Geometry, Interpolant, TableSet};

    use super::*;
    use crate::board::possible;

    /// The longest packets differ from the shortest by 2 · (4080 + 16) = 8,192 bytes there and back, in 10 ms.
    #[test]
    fn the_speed_of_a_link_comes_of_what_its_longest_packets_take() {
        assert_eq!(carried(0.002, 0.012).round(), 819_200.0);
        // Not infinite, and not negative.
        assert_eq!(carried(0.012, 0.010).round(), 819_200.0);
        assert_eq!(carried(0.0, 0.0), f64::INFINITY);
    }

    #[test]
    fn a_board_that_nobody_has_asked_is_one_that_there_can_be() {
        for width in [64, 1920, 2592] {
            let geometry = Geometry::centred(width, 8, BitDepth::Twelve).unwrap();
            let tables = TableSet::from_lens(geometry, &Equidistant::default(), None).unwrap();
            let plan = Plan::new(tables, Interpolant::Hermite.into());
            let board = usual_capabilities(&plan, BoardNature::Hardware);
            assert!(possible(&board).is_ok(), "{width}");
        }
    }
}
