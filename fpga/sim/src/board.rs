//! A simulated board at the end of a pipe.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

use halfrow_pipe::Endpoint;

use crate::byte_port::BytePort;
use crate::ffi;
use crate::ft2232h::Ft2232h;
use crate::port::{Port, Step};
use crate::uart::Uart;

/// Clocks of the core without a byte taken after which a design that is not at rest never will be. The longest that it may work
/// on its own is a burst that uses up all its records: 16 frames of the greatest size, with blankings of a thousand clocks.
const PATIENCE: u32 = 150_000_000;

/// The same for boards with pins. There a step is an edge of either clock, and 2.3 edges come in a clock of the core.
const PATIENCE_AT_PINS: u32 = PATIENCE / 10 * 23;

/// Only the 10 s rule depends on time, so a longer silence is cut to this.
const MOST_MILLISECONDS: u64 = 11_000;

/// The way by which bytes enter the board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Front {
    /// None: the bridge's own byte ports.
    Bytes,
    /// A UART with RTS and CTS, 8 clocks a bit.
    Uart,
    /// An FT2232H as an asynchronous FIFO.
    Fifo,
}

/// A build of the board with byte ports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Build {
    /// The build that ships: seven taps, two banks of everything.
    Shipped,
    /// Four row banks each way.
    #[cfg(feature = "builds")]
    FourRowBanks,
    /// Four row banks in, two out.
    #[cfg(feature = "builds")]
    FourRowBanksIn,
    /// Five taps, one bank of tables and no trap, with four row banks each way.
    #[cfg(feature = "builds")]
    FiveTapsOneBank,
}

/// Why a simulated board will not answer any more.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Failure {
    /// It never comes to rest.
    #[error(
        "the design was not at rest {clocks} clocks behind the last byte that it took; look at its waveform with trace=FILE"
    )]
    Hung {
        /// The number of clocks, of either clock.
        clocks: u32,
    },
    /// It does something that the chip at its pins does not allow.
    #[error("the design breaks the FT2232H's rules at {} ns: {rule}", picoseconds / 1000)]
    Rule {
        /// The rule that it breaks.
        rule: &'static str,
        /// When, in simulated time.
        picoseconds: u64,
    },
    /// Its waveform cannot be written on.
    #[error(transparent)]
    Trace(#[from] TraceError),
}

/// The waveform of the simulated board cannot be written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TraceError {
    /// A file or a link of that name exists.
    #[error("{0} is there already; remove it, or choose another place for the waveform with trace=FILE")]
    Exists(PathBuf),
    /// The file cannot be opened, or takes no more.
    #[error("the waveform {0} cannot be written; choose another place with trace=FILE")]
    Unwritable(PathBuf),
}

/// The Verilog under simulation. Like the mock it takes no time of its own: when bytes arrive, it is clocked until it is at
/// rest.
pub struct Board {
    machine: Box<dyn Machine>,
    outgoing: Vec<u8>,
    /// Milliseconds that the design has been told of.
    milliseconds: u64,
    failure: Option<Failure>,
    /// The file of the waveform, if one is written.
    waveform: Option<PathBuf>,
}

impl Board {
    /// The build that ships, behind `front`, switched on and reset. `seed` draws the initial contents of its registers and
    /// memories.
    #[must_use]
    pub fn new(front: Front, seed: u32) -> Self {
        match front {
            Front::Bytes => Self::of_build(Build::Shipped, seed),
            Front::Uart => Self::with(Uart::new(seed), PATIENCE_AT_PINS),
            Front::Fifo => Self::with(Ft2232h::new(seed), PATIENCE_AT_PINS),
        }
    }

    /// A build with byte ports, switched on and reset; `seed` as in [`Self::new`].
    #[must_use]
    pub fn of_build(build: Build, seed: u32) -> Self {
        let functions = match build {
            Build::Shipped => &ffi::halfrow_bridge,
            #[cfg(feature = "builds")]
            Build::FourRowBanks => &ffi::halfrow_bridge_four,
            #[cfg(feature = "builds")]
            Build::FourRowBanksIn => &ffi::halfrow_bridge_in,
            #[cfg(feature = "builds")]
            Build::FiveTapsOneBank => &ffi::halfrow_bridge_lean,
        };
        Self::with(BytePort::new(functions, seed), PATIENCE)
    }

    /// The design behind `port`, reset. After `patience` steps without a byte taken it is given up.
    pub(crate) fn with<P: Port + 'static>(mut port: P, patience: u32) -> Self {
        port.reset();
        let machine = Box::new(Clocked { port, patience });
        Self { machine, outgoing: Vec::new(), milliseconds: 0, failure: None, waveform: None }
    }

    /// From now on writes a waveform of the whole design to `path`, in VCD. Builds for tests have none.
    ///
    /// # Errors
    /// [`TraceError`] if the file already exists, be it as a link that leads nowhere, or cannot be opened.
    pub fn trace(&mut self, path: &Path) -> Result<(), TraceError> {
        // Made here, since the simulation would write through a link and over a file.
        File::create_new(path).map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => TraceError::Exists(path.to_owned()),
            _ => TraceError::Unwritable(path.to_owned()),
        })?;
        if self.machine.trace(path) {
            self.waveform = Some(path.to_owned());
            return Ok(());
        }
        _ = fs::remove_file(path);
        Err(TraceError::Unwritable(path.to_owned()))
    }

    fn check_waveform(&mut self) -> Result<(), Failure> {
        match &self.waveform {
            Some(path) if !self.machine.is_traced() => Err(TraceError::Unwritable(path.clone()).into()),
            _ => Ok(()),
        }
    }

    /// Milliseconds that have passed since those that the design was last told of.
    fn pass(&mut self, now: Duration) -> u64 {
        let now = u64::try_from(now.as_millis()).unwrap_or(u64::MAX);
        let passed = now.saturating_sub(self.milliseconds);
        self.milliseconds = self.milliseconds.max(now);
        passed.min(MOST_MILLISECONDS)
    }
}

impl Endpoint for Board {
    type Failure = Failure;

    fn receive(&mut self, bytes: &[u8], now: Duration) -> Result<(), Failure> {
        if let Some(failure) = &self.failure {
            return Err(failure.clone());
        }
        let milliseconds = self.pass(now);
        let done =
            self.machine.run(milliseconds, bytes, &mut self.outgoing).and_then(|()| self.check_waveform());
        self.failure = done.clone().err();
        done
    }

    fn outgoing(&mut self) -> &mut Vec<u8> {
        &mut self.outgoing
    }
}

/// A design and the far end of its link, of whatever kind.
trait Machine: Send {
    /// Lets milliseconds pass, hands over bytes, and clocks the design until it is at rest. Appends to `said` what it says.
    fn run(&mut self, milliseconds: u64, bytes: &[u8], said: &mut Vec<u8>) -> Result<(), Failure>;

    fn trace(&mut self, path: &Path) -> bool;

    fn is_traced(&mut self) -> bool;
}

struct Clocked<P> {
    port: P,
    /// Steps without a byte taken after which the design is given up.
    patience: u32,
}

impl<P: Port> Machine for Clocked<P> {
    fn run(&mut self, milliseconds: u64, bytes: &[u8], said: &mut Vec<u8>) -> Result<(), Failure> {
        for _ in 0..milliseconds {
            let Step { sent, .. } = self.port.step(None, true)?;
            said.extend(sent);
        }
        let mut bytes = bytes.iter().copied().peekable();
        let (mut waited, mut rested) = (0, 0);
        while rested < P::REST {
            let Step { taken, sent, quiet } = self.port.step(bytes.peek().copied(), false)?;
            said.extend(sent);
            rested = if quiet { rested + 1 } else { 0 };
            waited += 1;
            if taken {
                bytes.next();
                waited = 0;
            }
            if waited == self.patience {
                return Err(Failure::Hung { clocks: self.patience });
            }
        }
        Ok(())
    }

    fn trace(&mut self, path: &Path) -> bool {
        self.port.trace(path)
    }

    fn is_traced(&mut self) -> bool {
        self.port.is_traced()
    }
}
