//! The board's Verilog under simulation, as a link.

use std::path::Path;

use halfrow_pipe::PipeSetup;
use halfrow_sim::{Board, Front};

use super::OpenError;
use super::open::{PACE, options_of, pace, take, with_keys, wrong_options};
use super::{Link, WireLink};
use crate::kinds::TRACE;
use crate::target::Target;

const SIMULATED: &str = "the simulated board";

/// The seed for the contents of memories and registers at power-up.
const SEED: u32 = 1;

/// What a target asks for.
struct SimOptions<'a> {
    front: Front,
    setup: PipeSetup,
    paced: bool,
    /// The file of the waveform.
    trace: Option<&'a str>,
}

pub(super) fn check_simulated(target: &Target) -> Result<(), OpenError> {
    asked(target).map(drop)
}

fn asked(target: &Target) -> Result<SimOptions<'_>, OpenError> {
    let front = match target.address.as_deref() {
        None => Front::Bytes,
        Some("uart") => Front::Uart,
        Some("fifo") => Front::Fifo,
        Some(other) => return Err(OpenError::UnknownFront(other.to_owned())),
    };
    let mut options = options_of(target);
    let paced = pace(SIMULATED, target, &mut options)?;
    let trace = take(SIMULATED, target, &mut options, TRACE)?;
    let setup = PipeSetup::from_options(&options)
        .map_err(|source| wrong_options(SIMULATED, target, with_keys(source, &[PACE, TRACE])))?;
    Ok(SimOptions { front, setup, paced, trace })
}

pub(super) fn open_simulated(target: &Target) -> Result<Box<dyn Link>, OpenError> {
    let SimOptions { front, setup, paced, trace } = asked(target)?;
    let mut board = Board::new(front, SEED);
    if let Some(file) = trace {
        board.trace(Path::new(file))?;
    }
    Ok(Box::new(WireLink::new(setup.connect(board), SIMULATED, paced)))
}
