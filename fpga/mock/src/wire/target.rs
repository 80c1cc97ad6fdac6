//! From the options of a target string to a wire with a board at its end.

use std::collections::BTreeSet;

use super::fault::{WireFault, WireFaultError};
use super::options::WireOptions;
use super::value::WireValueError;
use super::{Board, Endpoint, Wire};
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

/// Options that make no wire, or no mock board at its end.
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
    /// A fault that this board cannot have.
    #[error("fault={name} is one of the mock board; leave it out, or choose one of the wire: {known}")]
    MockFault {
        /// The name that was given.
        name: String,
        /// The names that the wire's faults have.
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
    #[error("{key} is no option of this board; choose from {known}")]
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

/// A wire that no board is connected to yet.
#[derive(Clone, Debug, PartialEq)]
pub struct WireSetup {
    options: WireOptions,
    fault: Option<WireFault>,
}

impl WireSetup {
    /// The wire that the options of a target string describe, as in `speed=1200000,fault=flip,rate=1e-4`, to a board that
    /// has no options itself: those of the wire ([`WireOptions::set`]), and at most one of its faults with its parameters
    /// ([`WireFault::from_name`]).
    ///
    /// # Errors
    /// [`WireError`] when a key is unknown or given twice, or a value is out of range.
    pub fn from_options(options: &[(&str, &str)]) -> Result<Self, WireError> {
        parse(options, None).map(|(setup, _)| setup)
    }

    /// The wire with `board` at its end, which is switched on now.
    #[must_use]
    pub fn connect<B: Endpoint>(self, board: B) -> Wire<B> {
        Wire::new(board, self.options, self.fault)
    }
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
        let (setup, board_fault) = parse(options, Some(&mut build))?;
        Ok(setup.connect(Board::new(&build, board_fault)?))
    }

    /// The fault of the board that [`Self::from_options`] would build from the same options, if it has one.
    ///
    /// # Errors
    /// [`WireError`] as there, but for a build that cannot exist.
    pub fn board_fault(options: &[(&str, &str)]) -> Result<Option<BoardFault>, WireError> {
        parse(options, Some(&mut Options::default())).map(|(_, fault)| fault)
    }
}

/// The wire and the board's fault that `options` describe. Without a `build` the board is no mock, which alone has options and
/// faults.
fn parse(
    options: &[(&str, &str)],
    mut build: Option<&mut Options>,
) -> Result<(WireSetup, Option<BoardFault>), WireError> {
    let mut wire = WireOptions::default();
    let mut faults = Faults { of_mock: build.is_some(), ..Faults::default() };
    let mut parameters = Parameters::new();
    let mut seen = BTreeSet::new();
    for &(key, value) in options {
        if key == FAULT {
            faults.add(value)?;
        } else if !seen.insert(key) {
            return Err(WireError::Duplicate { key: key.to_owned() });
        } else {
            let of_build = build.as_deref_mut().map_or(Ok(false), |build| build.set(key, value))?;
            if !of_build && !wire.set(key, value)? {
                parameters.insert(key.to_owned(), value.to_owned());
            }
        }
    }
    let (fault, board_fault) = faults.make(&parameters)?;
    Ok((WireSetup { options: wire, fault }, board_fault))
}

/// The faults that were asked for.
#[derive(Debug, Default)]
struct Faults {
    /// Whether the board is the mock, which can have some.
    of_mock: bool,
    wire: Option<&'static FaultInfo>,
    board: Option<&'static FaultInfo>,
}

impl Faults {
    fn add(&mut self, name: &str) -> Result<(), WireError> {
        let fault = catalogue()
            .iter()
            .find(|fault| fault.name == name)
            .ok_or_else(|| WireError::UnknownFault { name: name.to_owned(), known: self.known_faults() })?;
        if fault.place == Place::Board && !self.of_mock {
            return Err(WireError::MockFault { name: name.to_owned(), known: self.known_faults() });
        }
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

    /// The names of the faults that the wire and this board can have.
    fn known_faults(&self) -> String {
        let can_be = |fault: &&FaultInfo| self.of_mock || fault.place == Place::Wire;
        let names: Vec<_> = catalogue().iter().filter(can_be).map(|fault| fault.name).collect();
        names.join(", ")
    }

    /// The options that exist; and what the chosen faults take, which their summaries say.
    fn known_keys(&self) -> String {
        let build = BOARD_KEYS.into_iter().filter(|_| self.of_mock);
        let options: Vec<_> = build.chain(WireOptions::KEYS).chain([FAULT]).collect();
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
        let mut faults = Faults { of_mock: true, ..Faults::default() };
        faults.add("flip").unwrap();
        faults.add("lost-row").unwrap();
        let given = Parameters::from([("row".to_owned(), "3".to_owned())]);
        let none = Parameters::new();
        let (key, wire, board) = ("row".to_owned(), "flip".to_owned(), "lost-row".to_owned());
        assert_eq!(faults.check_use(&given, &none, &none), Err(WireError::Ambiguous { key, wire, board }));
        assert_eq!(faults.check_use(&given, &given, &none), Ok(()));
    }
}
