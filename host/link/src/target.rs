//! Target strings: `KIND[:ADDRESS][,KEY=VALUE]…` names a board, without characters that a shell would interpret. Blanks after a
//! comma are ignored. A recording takes no options, so all that follows `replay:` is its path, commas and blanks included.

use std::fmt;
use std::str::FromStr;

use halfrow_protocol::message::BoardNature;
use serde::{Deserialize, Serialize};

/// What a target begins with that names a recording.
const RECORDING: &str = "replay:";

/// A target string split into its parts, which are not looked up yet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Target {
    /// `mock`, `replay`, ….
    pub kind: String,
    /// What follows the colon.
    pub address: Option<String>,
    /// The options, in order.
    pub options: Vec<(String, String)>,
}

/// What is at the other end of a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum BoardKind {
    /// The mock board.
    Mock,
    /// The Verilog under simulation.
    Sim,
    /// A recording.
    Replay,
    /// A physical board.
    Hardware,
}

impl BoardKind {
    /// The kind that the board turns out to be: a link that leaves this process may lead to a mock or a simulation, which says
    /// so.
    #[must_use]
    pub fn confirmed_by(self, nature: BoardNature) -> Self {
        match (self, nature) {
            (Self::Hardware, BoardNature::Simulation) => Self::Sim,
            (Self::Hardware, BoardNature::Mock) => Self::Mock,
            (kind, _) => kind,
        }
    }
}

impl fmt::Display for BoardKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Mock => "mock",
            Self::Sim => "sim",
            Self::Replay => "replay",
            Self::Hardware => "hardware",
        })
    }
}

/// Text that names no target.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TargetError {
    /// The target is empty, and so names no board.
    #[error("an empty target names no board; write `mock`, or see `halfrow boards`")]
    Empty,
    /// An option in the target is not written as KEY=VALUE.
    #[error("`{option}` in the target `{target}` is no option; write KEY=VALUE")]
    Option {
        /// The piece between the commas.
        option: String,
        /// The whole.
        target: String,
    },
}

impl Target {
    /// The mock board with default options.
    #[must_use]
    pub fn mock() -> Self {
        Self { kind: "mock".to_owned(), address: None, options: Vec::new() }
    }

    /// The value of the first option that is called `key`.
    #[must_use]
    pub fn option(&self, key: &str) -> Option<&str> {
        self.options.iter().find(|(name, _)| name == key).map(|(_, value)| value.as_str())
    }
}

impl FromStr for Target {
    type Err = TargetError;

    fn from_str(text: &str) -> Result<Self, TargetError> {
        let ends = if text.starts_with(RECORDING) { None } else { text.split_once(',') };
        let (board, options) = ends.map_or((text, None), |(board, options)| (board, Some(options)));
        let (kind, address) = match board.split_once(':') {
            Some((kind, address)) => (kind, Some(address.to_owned())),
            None => (board, None),
        };
        if kind.is_empty() {
            return Err(TargetError::Empty);
        }
        let options = options
            .into_iter()
            .flat_map(|options| options.split(','))
            .map(str::trim_start)
            .map(|option| match option.split_once('=') {
                Some((key, value)) if !key.is_empty() => Ok((key.to_owned(), value.to_owned())),
                _ => Err(TargetError::Option { option: option.to_owned(), target: text.to_owned() }),
            })
            .collect::<Result<_, _>>()?;
        Ok(Self { kind: kind.to_owned(), address, options })
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.kind)?;
        if let Some(address) = &self.address {
            write!(f, ":{address}")?;
        }
        self.options.iter().try_for_each(|(key, value)| write!(f, ",{key}={value}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_target_comes_apart_and_back_together() {
        let text = "serial:/dev/ttyUSB1,baud=12000000,flow=rtscts";
        let target: Target = text.parse().unwrap();
        assert_eq!((target.kind.as_str(), target.address.as_deref()), ("serial", Some("/dev/ttyUSB1")));
        assert_eq!(target.options[0], ("baud".to_owned(), "12000000".to_owned()));
        assert_eq!(target.to_string(), text);
        assert_eq!("mock".parse::<Target>().unwrap().to_string(), "mock");
        assert_eq!("mock, latency=12".parse::<Target>(), "mock,latency=12".parse());
        assert_eq!("tcp:host:3001".parse::<Target>().unwrap().address.as_deref(), Some("host:3001"));
    }

    #[test]
    fn the_name_of_a_recording_is_all_that_follows() {
        for name in ["night, 2.rec", "a,b=1.rec", "a:b", ","] {
            let text = format!("replay:{name}");
            let target: Target = text.parse().unwrap();
            assert_eq!((target.address.as_deref(), &target.options[..]), (Some(name), &[][..]));
            assert_eq!(target.to_string(), text);
        }
    }

    #[test]
    fn what_names_no_board_is_refused() {
        assert_eq!("".parse::<Target>(), Err(TargetError::Empty));
        assert_eq!(":x".parse::<Target>(), Err(TargetError::Empty));
        assert!(matches!("mock,".parse::<Target>(), Err(TargetError::Option { .. })));
        assert!(matches!("mock,=1".parse::<Target>(), Err(TargetError::Option { .. })));
    }
}
