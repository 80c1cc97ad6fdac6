//! From the options of a target string to a wire with a board at its end.

use std::collections::BTreeSet;

use super::fault::{WireFault, WireFaultError};
use super::options::WireOptions;
use super::value::WireValueError;
use super::{Board, Wire};
use crate::faults::{BoardFault, FaultError, FaultInfo, Parameters, Place, catalogue};
use crate::options::{OptionError, Options};

/// The key that names a fault.
const FAULT: &str = "fault";

/// The keys that [`Options::set`] takes.
const BOARD_KEYS: [&str; 11] = [
    "latency",
    "ring",
    "least-blanking",
    "row-banks-in",
    "row-banks-out",
    "table-banks",
    "taps",
    "max-width",
    "max-height",
    "depths",
    "pixel-clock",
];

/// Options that make no mock board.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WireError {
    /// An option of the board's build is wrong, or does not fit another.
    #[error("the board cannot be built like this; correct its options or leave them out")]
    Board(#[from] OptionError),
    /// An option of the wire is wrong.
    #[error("the wire cannot be like this; correct its options or leave them out")]
    Value(#[from] WireValueError),
    /// A fault of the board cannot be made.
    #[error("the board's fault cannot be made; see the list of faults")]
    BoardFault(#[from] FaultError),
    /// A fault of the wire cannot be made.
    #[error("the wire's fault cannot be made; see the list of faults")]
    WireFault(#[from] WireFaultError),
    /// No fault has this name.
    #[error("no fault is called {name}; choose from {known}")]
    UnknownFault {
        /// The name that was given.
        name: String,
        /// The names that exist.
        known: String,
    },
    /// Two faults of the same kind.
    #[error(
        "fault={first} and fault={second} cannot be had together; keep one, or combine one of the wire with one of the board"
    )]
    TwoFaults {
        /// The one given first.
        first: String,
        /// The one given after it.
        second: String,
    },
    /// A key that nothing takes.
    #[error("{key} is no option of this mock board; choose from {known}")]
    UnknownKey {
        /// The key that was given.
        key: String,
        /// The options that exist, and the faults that were asked for with their parameters.
        known: String,
    },
    /// A key that both faults take.
    #[error(
        "{key} means something to fault={wire} and to fault={board}; leave it out, or leave out one of the faults"
    )]
    Ambiguous {
        /// The key that was given.
        key: String,
        /// The fault of the wire.
        wire: String,
        /// The fault of the board.
        board: String,
    },
    /// A key that was given before.
    #[error("{key} is given twice; keep one")]
    Duplicate {
        /// The key.
        key: String,
    },
}

impl Wire {
    /// The mock board that the options of a target string describe, as in
    /// `mock,fault=flip,rate=1e-4,seed=3,latency=10,speed=1200000,delay=0.001`: those of the board's build
    /// ([`Options::set`]), those of the wire ([`WireOptions::set`]), and at most one fault of the wire and one of the board
    /// with their parameters ([`WireFault::from_name`], [`BoardFault::from_name`]).
    ///
    /// # Errors
    /// [`WireError`] when a key is unknown, given twice or taken by both faults, a value is out of range, or the build
    /// cannot exist.
    pub fn from_options(options: &[(&str, &str)]) -> Result<Self, WireError> {
        let mut build = Options::default();
        let mut wire = WireOptions::default();
        let mut faults = Faults::default();
        let mut parameters = Parameters::new();
        let mut seen = BTreeSet::new();
        for &(key, value) in options {
            if key == FAULT {
                faults.add(value)?;
            } else if !seen.insert(key) {
                return Err(WireError::Duplicate { key: key.to_owned() });
            } else if !build.set(key, value)? && !wire.set(key, value)? {
                parameters.insert(key.to_owned(), value.to_owned());
            }
        }
        let (wire_fault, board_fault) = faults.make(&parameters)?;
        Ok(Self::new(Board::new(&build, board_fault)?, wire, wire_fault))
    }
}

/// The faults that were asked for.
#[derive(Debug, Default)]
struct Faults {
    wire: Option<&'static FaultInfo>,
    board: Option<&'static FaultInfo>,
}

impl Faults {
    fn add(&mut self, name: &str) -> Result<(), WireError> {
        let fault = catalogue().iter().find(|fault| fault.name == name).ok_or_else(|| {
            let names: Vec<_> = catalogue().iter().map(|fault| fault.name).collect();
            WireError::UnknownFault { name: name.to_owned(), known: names.join(", ") }
        })?;
        let place = match fault.place {
            Place::Wire => &mut self.wire,
            Place::Board => &mut self.board,
        };
        match place.replace(fault) {
            None => Ok(()),
            Some(first) => {
                Err(WireError::TwoFaults { first: first.name.to_owned(), second: fault.name.to_owned() })
            }
        }
    }

    /// Makes the faults from `parameters`, each of which must be of use to exactly one of them.
    fn make(&self, parameters: &Parameters) -> Result<(Option<WireFault>, Option<BoardFault>), WireError> {
        let (mut left_by_wire, mut left_by_board) = (parameters.clone(), parameters.clone());
        let wire = self.wire.map(|fault| WireFault::from_name(fault.name, &mut left_by_wire)).transpose()?;
        let board =
            self.board.map(|fault| BoardFault::from_name(fault.name, &mut left_by_board)).transpose()?;
        self.check_use(parameters, &left_by_wire, &left_by_board)?;
        Ok((wire, board))
    }

    /// Whether each of the `given` parameters was taken, and left over by all but one fault.
    fn check_use(
        &self,
        given: &Parameters,
        left_by_wire: &Parameters,
        left_by_board: &Parameters,
    ) -> Result<(), WireError> {
        given.keys().try_for_each(|key| {
            match (left_by_wire.contains_key(key), left_by_board.contains_key(key)) {
                (true, true) => Err(WireError::UnknownKey { key: key.clone(), known: self.known_keys() }),
                (false, false) => Err(self.ambiguous(key)),
                _ => Ok(()),
            }
        })
    }

    fn ambiguous(&self, key: &str) -> WireError {
        let name = |fault: Option<&FaultInfo>| fault.map(|fault| fault.name.to_owned()).unwrap_or_default();
        WireError::Ambiguous { key: key.to_owned(), wire: name(self.wire), board: name(self.board) }
    }

    /// The options that exist; and what the chosen faults take, which their summaries say.
    fn known_keys(&self) -> String {
        let options: Vec<_> = BOARD_KEYS.into_iter().chain(WireOptions::KEYS).chain([FAULT]).collect();
        let options = options.join(", ");
        let chosen = [self.wire, self.board].into_iter().flatten();
        let faults: Vec<_> =
            chosen.map(|fault| format!("; fault={}: {}", fault.name, fault.summary)).collect();
        if faults.is_empty() {
            format!("{options}; a fault's parameters need fault=NAME")
        } else {
            format!("{options}{}", faults.concat())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_of_the_board_that_an_error_names_exists() {
        // A value that is wrong for all of them: what is refused is known.
        assert!(BOARD_KEYS.iter().all(|key| Options::default().set(key, "none").is_err()));
    }

    #[test]
    fn a_parameter_that_two_faults_take_is_refused() {
        let mut faults = Faults::default();
        faults.add("flip").unwrap();
        faults.add("lost-row").unwrap();
        let given = Parameters::from([("row".to_owned(), "3".to_owned())]);
        let none = Parameters::new();
        let (key, wire, board) = ("row".to_owned(), "flip".to_owned(), "lost-row".to_owned());
        assert_eq!(faults.check_use(&given, &none, &none), Err(WireError::Ambiguous { key, wire, board }));
        assert_eq!(faults.check_use(&given, &given, &none), Ok(()));
    }
}
