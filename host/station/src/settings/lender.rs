//! Which board a lane has: one of this computer's own, or one that labgrid lends.

use std::path::Path;

use halfrow::link::{self, kinds};
use halfrow::target::Target;

use super::read::{not_empty, program, seconds};
use super::stable::moving;
use super::text::{LabgridText, LaneText, SettingsText};
use crate::input_error::Fault;
use crate::labgrid::{KIND, Labgrid, LaneBoard, PROGRAM, Place};

/// How long it may take to acquire a place, in seconds.
const DEADLINE: f64 = 30.0;

/// Who has boards for lanes.
pub(super) struct Lender {
    station: String,
    labgrid: Labgrid,
}

impl Lender {
    /// What the settings say, in a file whose folder is `folder`.
    pub(super) fn of(folder: &Path, read: &SettingsText) -> Result<Self, Fault> {
        let LabgridText { coordinator, program: written, deadline } = &read.labgrid;
        let written = written.as_ref().map(not_empty).transpose()?.unwrap_or_else(|| PROGRAM.to_owned());
        let program = program(folder, &written);
        let coordinator = coordinator.as_ref().map(not_empty).transpose()?;
        let deadline = seconds(deadline.as_ref(), DEADLINE)?;
        let station = read.station.name.get_ref().trim().to_owned();
        Ok(Self { station, labgrid: Labgrid { program, coordinator, deadline } })
    }

    /// The board of the lane.
    pub(super) fn board(&self, text: &LaneText) -> Result<LaneBoard, Fault> {
        let at = &text.board;
        let board: Target =
            text.board.get_ref().parse().map_err(|error| Fault::input(at, "the board", error))?;
        if board.kind == KIND {
            return self.place(board, text);
        }
        if kinds::of(&board).is_none() {
            let what = format!("`{}` is not a kind of board", board.kind);
            let remedy = format!("write one as `halfrow boards` lists them, or {KIND}:PLACE");
            return Err(Fault::wrong(at, what, remedy));
        }
        if let Some((what, remedy)) = moving(&board) {
            return Err(Fault::wrong(at, what, remedy));
        }
        link::check(&board).map_err(|error| Fault::input(at, "the board", error))?;
        Ok(LaneBoard::Own(board))
    }

    fn place(&self, board: Target, text: &LaneText) -> Result<LaneBoard, Fault> {
        let written = board.to_string();
        match board.address {
            Some(name) if !name.trim().is_empty() && board.options.is_empty() => {
                let (lane, labgrid) = (text.name.get_ref(), self.labgrid.clone());
                Ok(LaneBoard::Lent(Place::new(name, &self.station, lane, labgrid)))
            }
            _ => {
                let what = format!("`{written}` names no place of labgrid's");
                let remedy = format!("write {KIND}:PLACE, with a name as `labgrid-client places` lists them");
                Err(Fault::wrong(&text.board, what, remedy))
            }
        }
    }
}
