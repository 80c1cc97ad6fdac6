//! What a fault does to each part of a board.

use super::BoardFault;
use crate::board::WrongClaims;
use crate::burst::{BurstDefects, SlowPath, WarmBit};
use crate::core::{CoreDefects, DeadTap, StuckBits};
use crate::player::{PlayerDefects, SpoiltSample};
use crate::tables::{Drift, FlippedBit, Stale, TableDefects};

/// What is wrong with each part of a board.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Defects {
    /// The datapath.
    pub(crate) core: CoreDefects,
    /// The tables.
    pub(crate) tables: TableDefects,
    /// What plays rows and collects them.
    pub(crate) player: PlayerDefects,
    /// What makes frames and signs them.
    pub(crate) burst: BurstDefects,
    /// What the board says of itself.
    pub(crate) claims: WrongClaims,
    /// What it makes of packets.
    pub(crate) packets: PacketDefects,
}

/// What is wrong with what a board makes of packets.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PacketDefects {
    /// Whether it carries out packets whatever session they name.
    pub(crate) takes_any_session: bool,
    /// Whether a ROW_ACK frees all output banks.
    pub(crate) frees_all: bool,
    /// Whether no row says that it was sent before.
    pub(crate) repeats_stand: bool,
}

impl PacketDefects {
    fn of(fault: Option<BoardFault>) -> Self {
        Self {
            takes_any_session: matches!(fault, Some(BoardFault::AnySession)),
            frees_all: matches!(fault, Some(BoardFault::GreedyAck)),
            repeats_stand: matches!(fault, Some(BoardFault::StuckRepeats)),
        }
    }
}

impl Defects {
    /// What is wrong with a board with `fault`.
    pub(crate) fn of(fault: Option<BoardFault>) -> Self {
        let mut defects = Self { packets: PacketDefects::of(fault), ..Self::default() };
        let Self { core, tables, player, burst, claims, .. } = &mut defects;
        match fault {
            None | Some(BoardFault::AnySession | BoardFault::GreedyAck | BoardFault::StuckRepeats) => {}
            Some(BoardFault::StuckData { bit, value }) => core.data_lines = StuckBits::one(bit, value),
            Some(BoardFault::StuckAddress { bit, value }) => core.address_lines = StuckBits::one(bit, value),
            Some(BoardFault::RowFactor { row, bit, hidden }) => {
                tables.entry = Some(FlippedBit { entry: row, bit, hidden });
            }
            Some(BoardFault::KernelWord { node, weight, bit, hidden }) => {
                tables.word = Some(FlippedBit { entry: (node, weight), bit, hidden });
            }
            Some(BoardFault::TapOffset { columns }) => core.tap_offset = columns.into(),
            Some(BoardFault::NoRounding) => core.rounding = 0,
            Some(BoardFault::DeadTap { tap, reads }) => core.dead_tap = Some(DeadTap { tap, reads }),
            Some(BoardFault::Late) => core.extra_delay = 1,
            Some(BoardFault::WrongLatencyClaim) => claims.latency = 1,
            Some(BoardFault::LostRow { row }) => player.lost_row = Some(row),
            Some(BoardFault::StaleTable { hidden }) => {
                tables.stale = Some(if hidden { Stale::Hidden } else { Stale::Admitted });
            }
            Some(BoardFault::DriftingTable { after, row, bit }) => {
                tables.drift = Some(Drift { after, entry: row, bit });
            }
            Some(BoardFault::UncheckedCommit) => tables.unchecked = true,
            Some(BoardFault::WrongDatapath) => claims.datapath = 8,
            Some(BoardFault::SpoiltRow { row, column, bit }) => {
                player.spoilt = Some(SpoiltSample { row, column, bit });
            }
            Some(BoardFault::SlowPath { bit, one_in, seed }) => {
                burst.slow_path = Some(SlowPath { bit, one_in, seed });
            }
            Some(BoardFault::WarmBit { after, row, bit }) => {
                burst.warm_bit = Some(WarmBit { after, row, bit });
            }
            Some(BoardFault::LateSwap) => burst.late_swap = true,
            Some(BoardFault::HiddenPause { row }) => burst.hidden_pause = Some(row),
        }
        defects
    }
}
