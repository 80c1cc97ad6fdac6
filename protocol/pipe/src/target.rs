//! From the options in a target string to a pipe with a board at its end.

use std::collections::BTreeSet;

use crate::catalogue::{Fault, FaultError, FaultInfo, Parameters, Place};
use crate::fault::{FAULTS, PipeFault};
use crate::options::PipeOptions;
use crate::value::ValueError;
use crate::{Endpoint, Pipe, meant};

/// The key that names a fault.
const FAULT: &str = "fault";

/// Options that make no pipe, or no board at its end.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TargetError {
    /// An option of the mock board's build has a wrong value, or does not go with another one.
    #[error("an option of the board is wrong")]
    Board(#[source] ValueError),
    /// An option of the simulated link has a wrong value, or does not go with another one.
    #[error("an option of the simulated link is wrong")]
    Pipe(#[source] ValueError),
    /// The mock board or its link cannot have the fault as it was asked for.
    #[error("the {}'s fault cannot be made", place.name())]
    Fault {
        /// What it would spoil.
        place: Place,
        /// Why.
        #[source]
        source: FaultError,
    },
    /// Neither the mock board nor its link has a fault of this name.
    #[error("no fault of this board is called `{name}`{}; choose from {known}", meant(.name, .known))]
    UnknownFault {
        /// The name that was given.
        name: String,
        /// The names that exist.
        known: String,
    },
    /// Two faults were asked for that cannot be had together, such as two of the board.
    #[error(
        "fault={first} and fault={second} cannot be had together; keep one, or combine one of the wire with one of the board"
    )]
    TwoFaults {
        /// The one given first.
        first: String,
        /// The one given after it.
        second: String,
    },
    /// The mock board has no option of this name.
    #[error("`{key}` is not an option of this board{}; choose from {known}", meant(.key, .known))]
    UnknownKey {
        /// The key that was given.
        key: String,
        /// The options that exist, and the faults that were asked for with their parameters.
        known: String,
    },
    /// Both of the faults that were asked for have a parameter of this name.
    #[error(
        "{key} means something to fault={pipe} and to fault={board}; leave it out, or leave out one of the faults"
    )]
    Ambiguous {
        /// The key that was given.
        key: String,
        /// The fault of the pipe.
        pipe: String,
        /// The fault of the board.
        board: String,
    },
    /// An option of the mock board was given twice.
    #[error("{key} is given twice; keep one")]
    Duplicate {
        /// The key.
        key: String,
    },
}

/// What a target string can set of the board at the end of a pipe.
pub trait BoardOptions {
    /// The board's deliberate faults.
    type Fault: 'static;

    /// The names of all options.
    const KEYS: &'static [&'static str];

    /// All faults.
    const FAULTS: &'static [Fault<Self::Fault>];

    /// Sets one option from text, as in `latency=12`. Returns false, with nothing changed, for a key that is no option.
    ///
    /// # Errors
    /// If the value is outside the option's own range.
    fn set(&mut self, key: &str, value: &str) -> Result<bool, ValueError>;
}

/// A board without options and faults.
#[derive(Clone, Copy, Debug)]
pub struct NoOptions;

impl BoardOptions for NoOptions {
    type Fault = std::convert::Infallible;

    const KEYS: &'static [&'static str] = &[];

    const FAULTS: &'static [Fault<Self::Fault>] = &[];

    fn set(&mut self, _: &str, _: &str) -> Result<bool, ValueError> {
        Ok(false)
    }
}

/// A pipe that no board is connected to yet.
#[derive(Clone, Debug, PartialEq)]
pub struct PipeSetup {
    options: PipeOptions,
    fault: Option<PipeFault>,
}

impl PipeSetup {
    /// The pipe that the options of a target string describe, as in `speed=1200000,fault=flip,rate=1e-4`, to a board
    /// without options. There may be options of the pipe ([`PipeOptions::set`]) and at most one of its faults with its
    /// parameters ([`FAULTS`]).
    ///
    /// # Errors
    /// [`TargetError`] when a key is unknown or given twice, or a value is out of range.
    pub fn from_options(options: &[(&str, &str)]) -> Result<Self, TargetError> {
        Self::with_board(options, &mut NoOptions).map(|(setup, _)| setup)
    }

    /// Like [`Self::from_options`], to a board with options, which are set in `board`. There may also be one fault of the
    /// board, with its parameters.
    ///
    /// # Errors
    /// [`TargetError`] when a key is unknown, given twice or taken by both faults, or a value is out of range.
    pub fn with_board<O: BoardOptions>(
        options: &[(&str, &str)],
        board: &mut O,
    ) -> Result<(Self, Option<O::Fault>), TargetError> {
        let mut pipe = PipeOptions::default();
        let mut faults = Faults::<O> { pipe: None, board: None };
        let mut parameters = Parameters::new();
        let mut seen = BTreeSet::new();
        for &(key, value) in options {
            if key == FAULT {
                faults.add(value)?;
            } else if !seen.insert(key) {
                return Err(TargetError::Duplicate { key: key.to_owned() });
            } else if !board.set(key, value).map_err(TargetError::Board)?
                && !pipe.set(key, value).map_err(TargetError::Pipe)?
            {
                parameters.insert(key.to_owned(), value.to_owned());
            }
        }
        let (fault, board_fault) = faults.make(parameters)?;
        Ok((Self { options: pipe, fault }, board_fault))
    }

    /// The pipe with `board` at its end, which is switched on now.
    #[must_use]
    pub fn connect<B: Endpoint>(self, board: B) -> Pipe<B> {
        Pipe::new(board, self.options, self.fault)
    }
}

/// The faults that were given.
struct Faults<O: BoardOptions> {
    pipe: Option<&'static Fault<PipeFault>>,
    board: Option<&'static Fault<O::Fault>>,
}

impl<O: BoardOptions> Faults<O> {
    fn add(&mut self, name: &str) -> Result<(), TargetError> {
        let first = if let Some(fault) = Fault::find(FAULTS, name) {
            self.pipe.replace(fault).map(|fault| fault.info)
        } else if let Some(fault) = Fault::find(O::FAULTS, name) {
            self.board.replace(fault).map(|fault| fault.info)
        } else {
            return Err(TargetError::UnknownFault { name: name.to_owned(), known: Self::known_faults() });
        };
        match first {
            None => Ok(()),
            Some(first) => {
                Err(TargetError::TwoFaults { first: first.name.to_owned(), second: name.to_owned() })
            }
        }
    }

    /// Makes the faults from `parameters`. Each parameter must belong to exactly one of them.
    fn make(&self, mut parameters: Parameters) -> Result<(Option<PipeFault>, Option<O::Fault>), TargetError> {
        parameters.keys().try_for_each(|key| self.check_use(key))?;
        Ok((made(self.pipe, &mut parameters)?, made(self.board, &mut parameters)?))
    }

    fn check_use(&self, key: &str) -> Result<(), TargetError> {
        let takers: Vec<_> = self.chosen().into_iter().filter(|fault| fault.takes(key)).collect();
        match *takers {
            [] => Err(TargetError::UnknownKey { key: key.to_owned(), known: self.known_keys() }),
            [_] => Ok(()),
            [pipe, board, ..] => Err(TargetError::Ambiguous {
                key: key.to_owned(),
                pipe: pipe.name.to_owned(),
                board: board.name.to_owned(),
            }),
        }
    }

    fn chosen(&self) -> Vec<FaultInfo> {
        let pipe = self.pipe.map(|fault| fault.info);
        pipe.into_iter().chain(self.board.map(|fault| fault.info)).collect()
    }

    /// The names of the faults that the pipe and this board can have.
    fn known_faults() -> String {
        let pipe = FAULTS.iter().map(|fault| fault.info.name);
        let names: Vec<_> = pipe.chain(O::FAULTS.iter().map(|fault| fault.info.name)).collect();
        names.join(", ")
    }

    /// The options that exist, and the summaries of the chosen faults, which name their parameters.
    fn known_keys(&self) -> String {
        let options: Vec<_> = O::KEYS.iter().copied().chain(PipeOptions::KEYS).chain([FAULT]).collect();
        let options = options.join(", ");
        let chosen = self.chosen();
        let faults: Vec<_> =
            chosen.iter().map(|fault| format!("; fault={}: {}", fault.name, fault.summary())).collect();
        if faults.is_empty() {
            format!("{options}; a fault's parameters need fault=NAME")
        } else {
            format!("{options}{}", faults.concat())
        }
    }
}

fn made<T>(fault: Option<&Fault<T>>, from: &mut Parameters) -> Result<Option<T>, TargetError> {
    fault
        .map(|fault| {
            fault.make(from).map_err(|source| TargetError::Fault { place: fault.info.place, source })
        })
        .transpose()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{Parameter, Range};

    /// A board with a fault that has a parameter in common with a fault of the pipe.
    struct Seedy;

    impl BoardOptions for Seedy {
        type Fault = ();

        const KEYS: &'static [&'static str] = &[];

        const FAULTS: &'static [Fault<()>] = &[Fault::new(
            "seedy",
            Place::Board,
            "something has a seed",
            &[Parameter::new("seed", Range::Whole(0, 9), Some("0"), "the seed")],
            |_| Ok(()),
        )];

        fn set(&mut self, _: &str, _: &str) -> Result<bool, ValueError> {
            Ok(false)
        }
    }

    #[test]
    fn a_parameter_that_two_faults_take_is_refused() {
        let refused = PipeSetup::with_board(
            &[("fault", "flip"), ("fault", "seedy"), ("rate", "0.5"), ("seed", "3")],
            &mut Seedy,
        );
        let (key, pipe, board) = ("seed".to_owned(), "flip".to_owned(), "seedy".to_owned());
        assert_eq!(refused, Err(TargetError::Ambiguous { key, pipe, board }));
        PipeSetup::with_board(&[("fault", "seedy"), ("seed", "3")], &mut Seedy).unwrap();
    }
}
