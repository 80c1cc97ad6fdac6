//! The prices of frames at speed.

use std::time::Duration;

use halfrow_model::Geometry;
use halfrow_protocol::message::FrameRecord;

use super::burst::{BurstPlan, USUAL_CLOCK, datapath_of_all};
use super::{FEW_AT_SPEED, USUAL, corners};
use crate::board::{BoardNature, Bursts, Capabilities, Datapath, row_blanking};
use crate::run::plan::prices::Prices;
use crate::run::{AtSpeed, Plan};
use crate::tables::{Generation, datapath_of};

/// The payload of a request for records, and of its reply without the records.
const LOOK: (usize, usize) = (4, 10);

/// The most looks that are priced one by one. After these, each frame is taken to cost as much as in the second half of them.
const MOST_LOOKS: u32 = 1 << 14;
const HALF_OF_THEM: u32 = MOST_LOOKS / 2;

/// The burst of a usual run, with as many frames as `plan` asks for on a board with these `capabilities`.
pub(super) fn usual_burst(plan: &Plan, capabilities: &Capabilities, bursts: Bursts) -> BurstPlan {
    let burst = burst_of(plan, capabilities, bursts, 0);
    burst.of_frames(match plan.at_speed {
        AtSpeed::Off => burst.frames_in(Duration::ZERO),
        AtSpeed::For(time) => burst.frames_in(time),
        AtSpeed::Usual | AtSpeed::Soak(_) if capabilities.nature == BoardNature::Hardware => {
            burst.frames_in(USUAL)
        }
        AtSpeed::Usual | AtSpeed::Soak(_) => FEW_AT_SPEED,
    })
}

/// A burst with no frames yet of the tables of `plan`, whose seed is draw number `draw`.
pub(super) fn burst_of(plan: &Plan, capabilities: &Capabilities, bursts: Bursts, draw: u32) -> BurstPlan {
    let tables = &plan.tables;
    BurstPlan::new(tables.geometry(), capabilities, bursts, datapath_of(tables)).drawn(plan.seed, draw)
}

/// The pixel clock of a board, in hertz; the usual one if it names none.
pub(in crate::run) fn clock_hz(capabilities: &Capabilities) -> u32 {
    if capabilities.clock_hz == 0 { USUAL_CLOCK } else { capabilities.clock_hz }
}

/// The frames of the usual burst; none on a board that makes no bursts.
pub(in crate::run) fn most_frames(prices: &Prices<'_>) -> usize {
    let frames = |bursts| usual_burst(prices.plan, prices.capabilities, bursts).frames;
    prices.capabilities.bursts.map_or(0, frames) as usize
}

/// The price of a usual burst of `frames` frames: settings, the tables of the other bank, and every look at the records.
pub(in crate::run) fn price_of_frames(prices: &Prices<'_>, frames: u32) -> f64 {
    let other_bank = if prices.capabilities.table_banks > 1 { prices.upload() } else { 0.0 };
    prices.short_request()
        + other_bank
        + watching(prices, prices.plan.tables.geometry(), frames, datapath_of(&prices.plan.tables))
}

/// The price of all corners: tables for each bank, a row (with a grid, a frame) that brings the first into effect, and
/// two frames.
pub(in crate::run) fn price_of_corners(prices: &Prices<'_>) -> f64 {
    let corner = |tables: &Vec<Generation>| {
        let Some(active) = tables.first().map(|first| &first.tables) else { return 0.0 };
        let geometry = active.geometry();
        let upload = |own: &Generation| prices.short_request() + prices.upload_of(own.tables.entries().len());
        let uploads = tables.iter().map(upload).sum::<f64>();
        let rows = if active.shape().is_some() { geometry.height() } else { 1 };
        let datapath = datapath_of_all(tables);
        let between = row_blanking(prices.capabilities, geometry.width(), datapath_of(active)).into();
        let activated =
            prices.short_request() + prices.commit() + prices.rows(rows, geometry.width(), between);
        uploads + activated + prices.short_request() + watching(prices, geometry, 2, datapath)
    };
    corners::corners(prices.capabilities, prices.plan.seed).iter().map(corner).sum()
}

/// The price of a burst of `frames` frames, from the request on. Each look takes the records that exist by then, if any.
fn watching(prices: &Prices<'_>, geometry: &Geometry, frames: u32, datapath: Datapath) -> f64 {
    let Some(bursts) = prices.capabilities.bursts else { return 0.0 };
    let burst = BurstPlan::new(geometry, prices.capabilities, bursts, datapath);
    let (frame, look) = (burst.seconds(1), |records| {
        prices.rates.request(LOOK.0, LOOK.1 + records as usize * FrameRecord::BYTES)
    });
    let (mut seconds, mut had) = (prices.short_request(), 0);
    let (mut looks, mut half) = (0, (seconds, had));
    loop {
        let made = (seconds / frame) as u32;
        // Half of the board's records are made while the other half are fetched.
        let come = made.saturating_sub(had).min(u32::from(bursts.records / 2).max(1)).min(frames - had);
        seconds += look(come);
        had += come;
        looks += 1;
        if had >= frames {
            return seconds;
        }
        match looks {
            MOST_LOOKS => {
                let a_frame = (seconds - half.0) / f64::from((had - half.1).max(1));
                return seconds + f64::from(frames - had) * a_frame;
            }
            HALF_OF_THEM => half = (seconds, had),
            _ => {}
        }
        let wait = burst.look_again_in(frames - had).as_secs_f64();
        seconds += wait;
        // All looks that find nothing at once: on a slow clock there may be millions.
        let in_vain = ((f64::from(had + 1) * frame - seconds) / (look(0) + wait)).ceil().max(0.0);
        seconds += in_vain * (look(0) + wait);
    }
}

#[cfg(test)]
mod tests {
    use halfrow_model::{BitDepth, Geometry, Interpolant, TableSet};

    use super::*;
    use crate::run::{Rates, usual_capabilities};

    /// A frame takes 64·8 + 8 clocks. Over a link that takes no time, the looks are 250 ms apart if frames take longer
    /// than that, and 10 ms if they are short.
    #[test]
    fn frames_are_looked_for_until_the_last_is_made() {
        let geometry = Geometry::centred(64, 8, BitDepth::Twelve).unwrap();
        let lens = halfrow_model::Equidistant::from_radius(10.0).unwrap();
        let tables = TableSet::from_lens(geometry, &lens, None).unwrap();
        let plan = Plan::new(tables, Interpolant::Hermite.into());
        let usual = usual_capabilities(&plan, BoardNature::Hardware);
        let seconds = |clock_hz, frames| {
            let capabilities = Capabilities { clock_hz, ..usual.clone() };
            let rates = Rates { bytes_per_second: f64::INFINITY, round_trip: 0.0 };
            let prices = Prices::new(&plan, &capabilities, rates);
            (1000.0 * watching(&prices, &geometry, frames, Datapath::RowFactors)).round()
        };
        assert_eq!([1, 2, 3].map(|frames| seconds(1, frames)), [520e3, 1040e3, 1560e3]);
        // 52 s, 104 s: the first look after these.
        assert_eq!(seconds(10, 2), 104e3);
        // 5.2 s: 21 looks, and 42.
        assert_eq!([seconds(100, 1), seconds(100, 2)], [5250.0, 10_500.0]);
        // 52 us a frame: half of the 64 records a look.
        assert_eq!([seconds(10_000_000, 32), seconds(10_000_000, 33)], [10.0, 20.0]);
        // A day and more of such looks; the board makes their frames in less than the 10 ms between them.
        assert_eq!(seconds(10_000_000, 32 << 24), f64::from(10 << 24));
        assert_eq!(seconds(10_000_000, u32::MAX), f64::from(10 << 27));
    }
}
