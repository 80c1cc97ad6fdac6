//! A serial port as a link: locked for this program, and never waited for longer than a deadline.

mod boards;
mod driver;
mod error;
mod holder;
mod options;

use std::fs::{self, Metadata};
use std::io;
use std::os::fd::AsRawFd;
use std::os::unix::fs::{FileTypeExt, MetadataExt};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use nix::errno::Errno;
use nix::sys::stat::{major, minor};
use serialport::{ClearBuffer, ErrorKind, FlowControl, SerialPort, TTYPort};

use super::access::how_to_get_access;
use super::descriptor::{Gone, Pump, never_block};
use super::sysfs::{is_without_file, usb_device};
use super::{HEED, Link, LinkError, OpenError, bytes_per_second};
use crate::LineErrors;
use crate::ftdi::{self, Speed};
use crate::target::Target;
use driver::{Counts, hold_nothing_back};
use options::SerialOptions;

pub use boards::SerialBoard;
pub use error::SerialError;
pub use holder::{Holder, holders};
pub(crate) use holder::{by, keepers};

/// After this silence no stale byte is under way any more: a USB chip holds bytes back for up to 16 ms, if it cannot be told otherwise.
const QUIET: Duration = Duration::from_millis(20);
/// Then draining stops, even if the board goes on talking; the protocol recognises what is stale.
const LONGEST_DRAIN: Duration = Duration::from_millis(200);

/// A pipe to a board behind a serial port.
#[derive(Debug)]
pub(crate) struct SerialLink {
    port: TTYPort,
    pump: Pump,
    path: PathBuf,
    options: SerialOptions,
    opened: Instant,
    /// What the driver had counted when the port had been set and drained.
    counted_before: Option<Counts>,
    line_errors: LineErrors,
}

impl SerialLink {
    /// Checks that `target` names a path, with options of this kind, and that what is there now is no other thing than a port.
    pub(crate) fn check(target: &Target) -> Result<(), OpenError> {
        let (path, _) = asked(target)?;
        match fs::metadata(&path) {
            Ok(found) if is_no_port(&found) => Err(SerialError::NotAPort(path).into()),
            _ => Ok(()),
        }
    }

    /// Opens the port of a `serial:PATH` target, locked for this program, configures it, and drops what is in its buffers.
    ///
    /// # Errors
    /// [`OpenError`] when the port does not exist, another program has it, or it cannot be set as the target says.
    pub(crate) fn open(target: &Target) -> Result<Self, OpenError> {
        let (path, options) = asked(target)?;
        Ok(Self::open_port(path, options)?)
    }

    fn open_port(path: PathBuf, options: SerialOptions) -> Result<Self, SerialError> {
        let metadata = fs::metadata(&path).map_err(|error| failed(&path, error))?;
        if is_no_port(&metadata) {
            return Err(SerialError::NotAPort(path));
        }
        check_rate(&path, options.baud)?;
        let mut port = lock(&path, options)?;
        set_lines(&mut port, options);
        check_taken_rate(&port, &path, options.baud)?;
        if let Err(error) = hold_nothing_back(&port) {
            tracing::debug!("how long the port holds bytes back is left as it is: {error}");
        }
        never_block(port.as_raw_fd()).map_err(|error| failed(&path, error))?;
        let mut link = Self {
            counted_before: None,
            line_errors: LineErrors::default(),
            port,
            pump: Pump::default(),
            path,
            options,
            opened: Instant::now(),
        };
        link.drain();
        // What it dropped belongs to whoever had the port before.
        link.counted_before = Counts::of(&link.port);
        Ok(link)
    }

    /// Notes what the driver has counted since. A port that is gone says nothing any more, and what was noted stays.
    fn note_line_errors(&mut self) {
        if let Some(before) = &self.counted_before
            && let Some(now) = Counts::of(&self.port)
        {
            self.line_errors = now.since(before);
        }
    }

    /// Drops what is in the buffers, and what still comes out of the chip after that.
    fn drain(&mut self) {
        let _ = self.port.clear(ClearBuffer::All);
        let begun = Instant::now();
        let mut stale = Vec::new();
        loop {
            let before = stale.len();
            // If the port is gone, the next use of it will fail.
            let moved = self.pump.exchange(self.port.as_raw_fd(), &[], &mut stale, QUIET);
            if moved.is_err() || stale.len() == before || begun.elapsed() > LONGEST_DRAIN {
                break;
            }
        }
        if !stale.is_empty() {
            tracing::info!("{} stale bytes were dropped from {}", stale.len(), self.path.display());
        }
    }
}

impl Drop for SerialLink {
    /// Without this, closing waits up to half a minute until everything written has left.
    fn drop(&mut self) {
        let _ = self.port.clear(ClearBuffer::Output);
    }
}

impl Link for SerialLink {
    fn exchange(
        &mut self,
        outgoing: &[u8],
        incoming: &mut Vec<u8>,
        wait: Duration,
    ) -> Result<usize, LinkError> {
        let moved = self.pump.exchange(self.port.as_raw_fd(), outgoing, incoming, wait.min(HEED));
        self.note_line_errors();
        moved.map_err(|gone| match gone {
            Gone::HungUp => LinkError::Unplugged { link: self.name(), at: self.now() },
            Gone::Failed(source) => LinkError::Failed { link: self.name(), at: self.now(), source },
        })
    }

    fn now(&self) -> Duration {
        self.opened.elapsed()
    }

    fn bytes_per_second(&self) -> Option<f64> {
        Some(bytes_per_second(self.options.baud))
    }

    fn is_exclusive(&self) -> bool {
        true
    }

    fn waits_for_cts(&self) -> bool {
        self.options.rts_cts
    }

    fn name(&self) -> String {
        format!("the serial port {} ({} baud)", self.path.display(), self.options.baud)
    }

    fn line_errors(&self) -> LineErrors {
        self.line_errors
    }
}

/// The port and its settings.
fn asked(target: &Target) -> Result<(PathBuf, SerialOptions), OpenError> {
    let options = SerialOptions::parse(target)?;
    let path = target.address.as_ref().filter(|path| !path.is_empty());
    Ok((PathBuf::from(path.ok_or_else(|| OpenError::address_missing(target))?), options))
}

/// Whether this is certainly no port. It is not opened to find out, because that sets a port's lines.
fn is_no_port(found: &Metadata) -> bool {
    let device = found.rdev();
    let class = format!("/sys/dev/char/{}:{}/subsystem", major(device), minor(device));
    // A pseudo-terminal has no such entry.
    let is_other = || fs::read_link(class).is_ok_and(|class| !class.ends_with("tty"));
    !found.file_type().is_char_device() || is_other()
}

fn lock(path: &Path, options: SerialOptions) -> Result<TTYPort, SerialError> {
    let flow = if options.rts_cts { FlowControl::Hardware } else { FlowControl::None };
    let builder = serialport::new(path.to_string_lossy(), options.baud).flow_control(flow).exclusive(true);
    builder.open_native().map_err(|error| refused(path, error))
}

/// The error of the crate that opens ports, which names few of the system's errors.
fn refused(path: &Path, error: serialport::Error) -> SerialError {
    match error.kind {
        ErrorKind::NoDevice => SerialError::InUse { path: path.to_owned(), holders: keepers(path) },
        ErrorKind::Io(kind) => failed(path, io::Error::new(kind, error.description)),
        // What a system answers if a terminal's call is made on something else.
        _ if error.description.contains("typewriter") || error.description.contains("ioctl") => {
            SerialError::NotAPort(path.to_owned())
        }
        // Only the control group of a container or service says this; EACCES is another kind.
        _ if error.description == Errno::EPERM.desc() => SerialError::NotGiven(path.to_owned()),
        _ => failed(path, io::Error::other(error.description)),
    }
}

/// Sets DTR, and RTS unless flow control uses it. A port without these lines has nothing to set.
fn set_lines(port: &mut TTYPort, options: SerialOptions) {
    let set = port.write_data_terminal_ready(options.dtr);
    let set =
        set.and_then(|()| if options.rts_cts { Ok(()) } else { port.write_request_to_send(options.rts) });
    if let Err(error) = set {
        tracing::debug!("the port has no modem lines: {error}");
    }
}

fn check_rate(path: &Path, baud: u32) -> Result<(), SerialError> {
    let Some(device) = usb_device(path).filter(|device| device.vendor_id == ftdi::VENDOR) else {
        return Ok(());
    };
    let speed = Speed::of(device.device_version);
    let chip = match speed {
        Speed::High => "a high-speed FTDI chip",
        Speed::Full => "a full-speed FTDI chip",
    };
    let refused = |nearest| SerialError::Rate { path: path.to_owned(), chip, baud, nearest };
    speed.divisor(baud).map(|_| ()).map_err(refused)
}

/// Other drivers take the nearest rate too, but some report which one.
fn check_taken_rate(port: &TTYPort, path: &Path, baud: u32) -> Result<(), SerialError> {
    match port.baud_rate() {
        Ok(taken) if taken > 0 && f64::from(taken.abs_diff(baud)) > ftdi::TOLERANCE * f64::from(baud) => {
            Err(SerialError::OtherRate { path: path.to_owned(), baud, taken })
        }
        _ => Ok(()),
    }
}

fn failed(path: &Path, error: io::Error) -> SerialError {
    let path = path.to_owned();
    match error.kind() {
        io::ErrorKind::NotFound if is_without_file(&path) => SerialError::NotGiven(path),
        io::ErrorKind::NotFound => SerialError::Missing(path),
        // Such a path leads nowhere, whatever is plugged in.
        io::ErrorKind::NotADirectory => SerialError::NotAPort(path),
        _ if error.raw_os_error() == Some(Errno::ELOOP as i32) => SerialError::NotAPort(path),
        io::ErrorKind::PermissionDenied => {
            let remedy = how_to_get_access(&path, usb_device(&path).as_ref());
            SerialError::NotAllowed { remedy, path }
        }
        _ => SerialError::Other { path, source: error },
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use super::*;

    /// Its control group says EPERM, for which that crate has no kind (posix/error.rs of serialport 4.10).
    #[test]
    fn a_port_that_a_container_is_not_given_is_not_said_to_be_unplugged() {
        let path = Path::new("/dev/ttyUSB99");
        let error = serialport::Error::new(ErrorKind::Unknown, "Operation not permitted");
        let refused = refused(path, error);
        assert!(matches!(&refused, SerialError::NotGiven(port) if port == path), "{refused:?}");
        assert_eq!(refused.class(), crate::Class::Station);
        assert!(!refused.to_string().contains("unplug"), "{refused}");
        let missing = failed(path, io::ErrorKind::NotFound.into());
        assert!(matches!(missing, SerialError::Missing(_)), "{missing:?}");
    }

    /// Whoever asks a run to stop may send no signal.
    #[test]
    fn a_silent_port_is_not_waited_for_so_long_that_a_request_to_stop_goes_unnoticed() {
        const LONG: Duration = Duration::from_secs(60);
        let (_board, port) = TTYPort::pair().unwrap();
        let target = format!("serial:{}", port.name().unwrap()).parse().unwrap();
        let mut link = SerialLink::open(&target).unwrap();
        let begun = Instant::now();
        assert_eq!(link.exchange(&[], &mut Vec::new(), LONG).unwrap(), 0);
        assert!(begun.elapsed() < LONG);
    }

    /// They are of another session, or of a board that was started again.
    #[test]
    fn bytes_that_lay_in_a_port_before_it_was_opened_are_dropped() {
        let (mut board, port) = TTYPort::pair().unwrap();
        board.write_all(b"stale").unwrap();
        let target = format!("serial:{}", port.name().unwrap()).parse().unwrap();
        let mut link = SerialLink::open(&target).unwrap();
        board.write_all(b"fresh").unwrap();
        let (mut came, begun) = (Vec::new(), Instant::now());
        while came.len() < b"fresh".len() && begun.elapsed() < Duration::from_secs(60) {
            link.exchange(&[], &mut came, QUIET).unwrap();
        }
        assert_eq!(came, b"fresh");
    }
}
