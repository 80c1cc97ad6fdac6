//! What a fault does to each part of a board.

use super::{BoardFault, BoardFault as Fault};
use crate::board::WrongClaims;
use crate::burst::{BurstDefects, SlowPath, WarmBit};
use crate::core::{CoreDefects, DeadTap, StuckBits};
use crate::player::{CentreDefect, PlayerDefects, SpoiltSample};
use crate::tables::{Drift, FlippedBit, Stale, TableDefects};

/// What is wrong with each part of a board.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Defects {
    /// The datapath.
    pub(crate) core: CoreDefects,
    /// The tables.
    pub(crate) tables: TableDefects,
    /// The player and the out-banks.
    pub(crate) player: PlayerDefects,
    /// The maker and the signer of the board's own frames.
    pub(crate) burst: BurstDefects,
    /// What the board says about itself.
    pub(crate) claims: WrongClaims,
}

impl Defects {
    /// What is wrong with a board that has `fault`.
    #[expect(clippy::too_many_lines, reason = "one arm a fault")]
    pub(crate) fn of(fault: Option<BoardFault>) -> Self {
        let Some(fault) = fault else { return Self::default() };
        let mut defects = Self::default();
        let Self { core, tables, player, burst, claims } = &mut defects;
        match fault {
            Fault::StuckData { bit, value } => core.data_lines = StuckBits::one(bit, value),
            Fault::StuckAddress { bit, value } => core.address_lines = StuckBits::one(bit, value),
            Fault::RowFactor { row, bit, hidden } => {
                tables.entry = Some(FlippedBit { entry: row, bit, hidden });
            }
            Fault::KernelWord { node, weight, bit, hidden } => {
                tables.word = Some(FlippedBit { entry: (node, weight), bit, hidden });
            }
            Fault::TapOffset { columns } => core.tap_offset = columns.into(),
            Fault::NoRounding => core.rounding = 0,
            Fault::DeadTap { tap, reads } => core.dead_tap = Some(DeadTap { tap, reads }),
            Fault::Late => core.extra_delay = 1,
            Fault::CentreIgnored => player.centre = CentreDefect::Ignored,
            Fault::StuckCentre { bit, value } => player.centre = CentreDefect::stuck(bit, value),
            Fault::LostRow { row } => player.lost_row = Some(row),
            Fault::StaleTable { hidden } => {
                tables.stale = Some(if hidden { Stale::Hidden } else { Stale::Admitted });
            }
            Fault::DriftingTable { after, row, bit } => {
                tables.drift = Some(Drift { after, entry: row, bit });
            }
            Fault::UncheckedCommit => tables.unchecked = true,
            // The board asks for these by itself, where it treats packets.
            Fault::Conduct(_) => {}
            Fault::WrongLatencyClaim => claims.latency = 1,
            Fault::WrongDatapath => claims.datapath = 8,
            Fault::WrongClockClaim => claims.pll_hz = Some(1),
            Fault::SpoiltRow { row, column, bit } => {
                player.spoilt = Some(SpoiltSample { row, column, bit });
            }
            Fault::SlowPath { bit, one_in, seed } => {
                burst.slow_path = Some(SlowPath { bit, one_in, seed });
            }
            Fault::WarmBit { after, row, bit } => {
                burst.warm_bit = Some(WarmBit { after, row, bit });
            }
            Fault::LateSwap => burst.late_swap = true,
            Fault::HiddenPause { row } => burst.hidden_pause = Some(row),
            Fault::Misread(misread) => core.misread(misread),
        }
        defects
    }
}
