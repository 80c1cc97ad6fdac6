//! What the board says about itself.

use halfrow_protocol::message::{BoardNature, Capabilities, ClockSource, Grids, Status};

use super::Board;
use super::bursts::capability;
use crate::core::GridShape;
use crate::faults::Defects;
use crate::options::{Options, TapCount};
use crate::tables::{GRID_BLANKING, GRID_WIDTH};

/// The datapath of fpga/DATAPATH.md.
const DATAPATH: u16 = 1;
/// The datapath of its section on grids.
const FURTHER_DATAPATH: u16 = 2;
/// Ports by which the datapath reads row factors.
pub(super) const ROW_FACTOR_PORTS: u8 = 1;
/// Ports by which it reads nodes: i and i + 1 at once.
pub(super) const KERNEL_PORTS: u8 = 2;

/// How far the board's claims are above the truth; not at all by default.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct WrongClaims {
    /// The datapath id.
    pub(crate) datapath: u16,
    /// L, in pixel clocks.
    pub(crate) latency: u8,
    /// The pixel clock in hertz of a PLL that the board does not have.
    pub(crate) pll_hz: Option<u32>,
}

/// What a build says about the grids that it takes.
fn grids(options: &Options) -> Option<Grids> {
    options.datapath2.then(|| Grids {
        further_datapath: FURTHER_DATAPATH,
        entries: options.bank_entries(),
        ks: GridShape::KS.into_iter().fold(0, |ks, k| ks | 1 << k),
        grid_blanking: GRID_BLANKING,
        grid_width: GRID_WIDTH,
    })
}

impl Board {
    pub(super) fn capabilities(&self) -> Capabilities {
        let options = &self.options;
        let claims = Defects::of(self.fault).claims;
        Capabilities {
            datapath: DATAPATH + claims.datapath,
            max_width: options.max_width,
            max_height: options.max_height,
            depths: options.depths.iter().fold(0, |bits, depth| bits | 1 << ((depth.bits() - 8) / 2)),
            taps: match options.taps {
                TapCount::Five => 5,
                TapCount::Seven => 7,
            },
            latency: options.latency + claims.latency,
            ring: options.ring_size(),
            least_blanking: options.least_blanking,
            table_banks: options.table_banks,
            row_banks_in: options.row_banks_in,
            row_banks_out: options.row_banks_out,
            step_ports: ROW_FACTOR_PORTS,
            kernel_ports: KERNEL_PORTS,
            clock_source: if claims.pll_hz.is_some() { ClockSource::Pll } else { ClockSource::Host } as u8,
            clock_hz: claims.pll_hz.unwrap_or(options.pixel_clock),
            bursts: capability(options),
            entered: options.entered,
            grids: grids(options),
            nature: BoardNature::Mock,
            name: "halfrow mock board".to_owned(),
        }
    }

    /// The counters; `clear` resets them afterwards.
    pub(super) fn report(&mut self, clear: bool) -> Status {
        let status = Status {
            next_row_in: self.rows.next_row_in(),
            next_row_out: self.rows.acknowledged(),
            core_busy: u32::from(self.is_busy()),
            generation: self.tables.generation().into(),
            ..self.status
        };
        if clear {
            self.status = Status::default();
        }
        status
    }
}
