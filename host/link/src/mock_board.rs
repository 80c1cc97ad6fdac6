//! The mock board in this process, as a link.

use halfrow_mock::{BoardFault, ConnectError, board_build, board_fault};

use super::open::{PACE, options_of, pace, with_keys, wrong_options};
use super::{Link, OpenError, WireLink};
use crate::target::Target;

const MOCK: &str = "the mock board";

/// The fault that a `mock` target asks for, and the build that has it; none if it asks for none, or for another kind of target.
///
/// # Errors
/// [`OpenError`] when the mock board does not have these options.
pub fn fault(target: &Target) -> Result<Option<(BoardFault, halfrow_mock::Options)>, OpenError> {
    if target.kind != "mock" {
        return Ok(None);
    }
    let mut options = options_of(target);
    pace(MOCK, target, &mut options)?;
    let wrong = |source| wrong_options(MOCK, target, with_keys(source, &[PACE]));
    let Some(fault) = board_fault(&options).map_err(wrong)? else { return Ok(None) };
    Ok(Some((fault, board_build(&options).map_err(wrong)?)))
}

pub(crate) fn open_mock(target: &Target) -> Result<Box<dyn Link>, OpenError> {
    if let Some(address) = &target.address {
        return Err(OpenError::NoAddress { kind: target.kind.clone(), address: address.clone() });
    }
    let mut options = options_of(target);
    let paced = pace(MOCK, target, &mut options)?;
    let pipe = halfrow_mock::connect(&options).map_err(|error| match error {
        ConnectError::Target(source) => wrong_options(MOCK, target, with_keys(source, &[PACE])),
        other => wrong_options(MOCK, target, other),
    })?;
    Ok(Box::new(WireLink::new(pipe, MOCK, paced)))
}
