//! Two threads that keep a device's endpoints busy, and the queues between them and the link.

use std::any::Any;
use std::collections::VecDeque;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use super::transport::{Transport, UsbFailure};
use crate::LineErrors;

/// Bytes of a read: a multiple of every packet size, since a packet that does not fit is lost.
const READ: usize = 64 * 1024;

/// Bytes of a write. FPGAs have been seen to lose bytes of longer ones.
const WRITE: usize = 16 * 1024;

/// Bytes that may be waiting to be written. The caller counts them as sent.
const OUTGOING: usize = 2 * WRITE;

/// Bytes that may be waiting to be fetched. With more, the device has to wait. A board sends only what it has credit for, but
/// noise never ends.
const INCOMING: usize = 1 << 20;

/// How often the threads check whether they are still wanted.
const BREATH: Duration = Duration::from_millis(100);

/// The shortest wait for incoming bytes: the reading thread may have been kept from running for as long as its caller.
const LOOK: Duration = Duration::from_millis(20);

/// The longest wait for the last bytes to be written. By then a board frees itself.
const LAST: Duration = Duration::from_secs(10);

/// After so many writes in a row of which the device took nothing, it is assumed that it never will.
const VAIN: u32 = 2;

/// Takes a transfer apart and appends its data.
pub(super) type Unpack = dyn Fn(&[u8], &mut Vec<u8>, &mut LineErrors) + Send + Sync;

#[derive(Default)]
struct Queues {
    incoming: Vec<u8>,
    outgoing: VecDeque<u8>,
    /// Bytes that have left `outgoing` but are not written yet.
    in_flight: usize,
    /// Writes in a row of which the device took nothing.
    in_vain: u32,
    errors: LineErrors,
    failure: Option<UsbFailure>,
    is_over: bool,
}

struct Shared {
    transport: Box<dyn Transport>,
    unpack: Box<Unpack>,
    queues: Mutex<Queues>,
    /// Something has arrived, left, or failed.
    changed: Condvar,
}

impl Shared {
    fn queues(&self) -> MutexGuard<'_, Queues> {
        self.queues.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait<'a>(&self, queues: MutexGuard<'a, Queues>, time: Duration) -> MutexGuard<'a, Queues> {
        match self.changed.wait_timeout(queues, time) {
            Ok((queues, _)) => queues,
            Err(poisoned) => poisoned.into_inner().0,
        }
    }

    fn fail(&self, failure: UsbFailure) {
        let mut queues = self.queues();
        queues.failure.get_or_insert(failure);
        queues.is_over = true;
        self.changed.notify_all();
    }

    /// Keeps a read under way at all times, and does nothing in between that could wait.
    fn keep_reading(&self) {
        let mut buffer = vec![0; READ];
        let mut data = Vec::new();
        loop {
            let read = match self.transport.read(&mut buffer, BREATH) {
                Ok(read) => read,
                Err(failure) => return self.fail(failure),
            };
            let mut errors = LineErrors::default();
            (self.unpack)(&buffer[..read], &mut data, &mut errors);
            let mut queues = self.queues();
            queues.errors += errors;
            if !data.is_empty() {
                queues.incoming.append(&mut data);
                self.changed.notify_all();
            }
            while queues.incoming.len() > INCOMING && !queues.is_over {
                queues = self.wait(queues, BREATH);
            }
            if queues.is_over {
                return;
            }
        }
    }

    fn keep_writing(&self) {
        let mut bytes = Vec::with_capacity(WRITE);
        loop {
            let mut queues = self.queues();
            while bytes.is_empty() && queues.outgoing.is_empty() && !queues.is_over {
                queues = self.wait(queues, BREATH);
            }
            if queues.is_over {
                return;
            }
            let more = queues.outgoing.len().min(WRITE - bytes.len());
            bytes.extend(queues.outgoing.drain(..more));
            queues.in_flight = bytes.len();
            drop(queues);
            self.changed.notify_all();
            let written = match self.transport.write(&bytes, BREATH) {
                Ok(written) => written,
                Err(failure) => return self.fail(failure),
            };
            bytes.drain(..written);
            let mut queues = self.queues();
            queues.in_flight = bytes.len();
            queues.in_vain = if written == 0 { queues.in_vain + 1 } else { 0 };
            drop(queues);
            self.changed.notify_all();
        }
    }
}

/// The two threads at work.
pub(super) struct Threads {
    shared: Arc<Shared>,
    handles: Vec<JoinHandle<()>>,
}

impl Threads {
    /// # Errors
    /// The system's, when it has no thread left.
    pub(super) fn start(transport: Box<dyn Transport>, unpack: Box<Unpack>) -> io::Result<Self> {
        let queues = Mutex::new(Queues::default());
        let shared = Arc::new(Shared { transport, unpack, queues, changed: Condvar::new() });
        let mut threads = Self { shared, handles: Vec::new() };
        threads.spawn(Shared::keep_reading)?;
        threads.spawn(Shared::keep_writing)?;
        Ok(threads)
    }

    fn spawn(&mut self, work: fn(&Shared)) -> io::Result<()> {
        let shared = Arc::clone(&self.shared);
        let run = move || {
            // Otherwise a thread that ended would look like a silent board.
            if let Err(panic) = catch_unwind(AssertUnwindSafe(|| work(&shared))) {
                shared.fail(UsbFailure::Other(fault(panic.as_ref())));
            }
        };
        self.handles.push(thread::Builder::new().name("usb".to_owned()).spawn(run)?);
        Ok(())
    }

    /// Like [`Link::exchange`](crate::Link::exchange). What arrived before a failure is handed over first.
    pub(super) fn exchange(
        &self,
        outgoing: &[u8],
        incoming: &mut Vec<u8>,
        wait: Duration,
    ) -> Result<usize, UsbFailure> {
        let deadline = Instant::now() + wait.max(LOOK);
        let mut queues = self.shared.queues();
        loop {
            let room =
                if queues.failure.is_none() { OUTGOING - queues.outgoing.len().min(OUTGOING) } else { 0 };
            let taken = outgoing.len().min(room);
            queues.outgoing.extend(&outgoing[..taken]);
            let received = queues.incoming.len();
            incoming.append(&mut queues.incoming);
            if taken + received > 0 {
                self.shared.changed.notify_all();
                return Ok(taken);
            }
            if let Some(failure) = &queues.failure {
                return Err(failure.clone());
            }
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Ok(0);
            }
            queues = self.shared.wait(queues, left);
        }
    }

    pub(super) fn errors(&self) -> LineErrors {
        self.shared.queues().errors
    }

    /// Waits until everything is written, at most for `patience`, but not for a device that takes nothing.
    fn write_out(&self, patience: Duration) {
        let begun = Instant::now();
        let mut queues = self.shared.queues();
        while queues.outgoing.len() + queues.in_flight > 0
            && !queues.is_over
            && queues.in_vain < VAIN
            && begun.elapsed() < patience
        {
            queues = self.shared.wait(queues, BREATH);
        }
    }
}

impl Drop for Threads {
    /// Waits until everything is written, since the last packets of a session free the board.
    fn drop(&mut self) {
        self.write_out(LAST);
        self.shared.queues().is_over = true;
        self.shared.changed.notify_all();
        for thread in self.handles.drain(..) {
            // A thread that panicked has already made the link fail.
            let _ = thread.join();
        }
    }
}

/// The text of a panic.
fn fault(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    let text = text.unwrap_or("for no reason that is known");
    format!("the program itself has failed: {text}; report this line with the call that led to it")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Only a hang takes this long.
    const LONG: Duration = Duration::from_secs(300);

    /// A device that sends what is put into it, in pieces, and then fails or is silent. It takes bytes unless it is `stuck`.
    #[derive(Default)]
    struct Device {
        says: Mutex<VecDeque<Result<Vec<u8>, UsbFailure>>>,
        heard: Arc<Mutex<Vec<u8>>>,
        stuck: bool,
        /// Whether it takes only a byte at a time, after a while.
        trickles: bool,
        /// Whether reading panics.
        panics: bool,
    }

    impl Transport for Device {
        fn packet(&self) -> Option<usize> {
            None
        }

        fn request(&self, _: u8, _: u16, _: u16) -> Result<(), UsbFailure> {
            Ok(())
        }

        fn request_word(&self, _: u8, _: u16, _: u16) -> Result<u16, UsbFailure> {
            Ok(0)
        }

        fn read(&self, buffer: &mut [u8], wait: Duration) -> Result<usize, UsbFailure> {
            assert!(!self.panics, "the sky fell");
            let next = self.says.lock().unwrap().pop_front();
            match next {
                Some(said) => said.map(|bytes| {
                    buffer[..bytes.len()].copy_from_slice(&bytes);
                    bytes.len()
                }),
                None => {
                    thread::sleep(wait);
                    Ok(0)
                }
            }
        }

        fn write(&self, bytes: &[u8], wait: Duration) -> Result<usize, UsbFailure> {
            if self.stuck {
                thread::sleep(wait);
                return Ok(0);
            }
            // A device takes only what it has room for.
            let taken = bytes.len().min(if self.trickles { 1 } else { 1000 });
            thread::sleep(if self.trickles { wait } else { Duration::ZERO });
            self.heard.lock().unwrap().extend_from_slice(&bytes[..taken]);
            Ok(taken)
        }
    }

    fn threads(device: Device) -> Threads {
        Threads::start(Box::new(device), Box::new(|transfer, data, _| data.extend_from_slice(transfer)))
            .unwrap()
    }

    #[test]
    fn what_came_before_a_failure_is_handed_over_before_it() {
        let says = [Ok(vec![1, 2]), Ok(vec![3]), Err(UsbFailure::Gone)].into();
        let threads = threads(Device { says: Mutex::new(says), ..Device::default() });
        let mut incoming = Vec::new();
        let mut came = 0;
        let failure = loop {
            match threads.exchange(&[], &mut incoming, LONG) {
                Ok(_) => came = incoming.len(),
                Err(failure) => break failure,
            }
        };
        // What comes with an error is looked at by nobody.
        assert_eq!(came, incoming.len());
        assert!(matches!(failure, UsbFailure::Gone));
        assert_eq!(incoming, [1, 2, 3]);
        // It keeps failing, and takes nothing more.
        assert!(threads.exchange(&[7], &mut incoming, LONG).is_err());
    }

    #[test]
    fn a_thread_that_panics_is_no_silent_board() {
        let threads = threads(Device { panics: true, ..Device::default() });
        let begun = Instant::now();
        while !threads.handles[0].is_finished() {
            assert!(begun.elapsed() < LONG);
            thread::sleep(BREATH / 100);
        }
        let failure = threads.exchange(&[], &mut Vec::new(), Duration::ZERO).unwrap_err();
        assert!(failure.to_string().contains("the sky fell"), "{failure}");
    }

    #[test]
    fn all_that_was_taken_is_written_in_order_before_the_end() {
        let heard = Arc::new(Mutex::new(Vec::new()));
        let threads = threads(Device { heard: Arc::clone(&heard), ..Device::default() });
        let sent: Vec<u8> = (0..100_000_u32).map(|n| (n % 251) as u8).collect();
        let mut left = sent.as_slice();
        while !left.is_empty() {
            let taken = threads.exchange(left, &mut Vec::new(), LONG).unwrap();
            left = &left[taken..];
        }
        drop(threads);
        assert!(*heard.lock().unwrap() == sent);
    }

    #[test]
    fn a_device_that_takes_nothing_holds_up_neither_deadline_nor_end() {
        let threads = threads(Device { stuck: true, ..Device::default() });
        let begun = Instant::now();
        let mut taken = 0;
        for _ in 0..6 {
            taken += threads.exchange(&[0; 10_000], &mut Vec::new(), Duration::from_millis(50)).unwrap();
        }
        // What is waiting to be written, and what the writing thread holds.
        assert!(taken <= OUTGOING + WRITE, "{taken}");
        threads.write_out(LONG);
        assert!(!threads.shared.queues().outgoing.is_empty());
        drop(threads);
        assert!(begun.elapsed() < LONG, "{:?}", begun.elapsed());
    }

    /// At this speed what waits would take it more than half an hour.
    #[test]
    fn a_device_that_takes_a_byte_now_and_then_holds_up_no_end() {
        let threads = threads(Device { trickles: true, ..Device::default() });
        let begun = Instant::now();
        threads.exchange(&[0; OUTGOING], &mut Vec::new(), LONG).unwrap();
        threads.write_out(BREATH);
        assert!(begun.elapsed() < LONG, "{:?}", begun.elapsed());
        threads.shared.queues().is_over = true;
    }

    #[test]
    fn noise_without_end_does_not_fill_the_memory() {
        let says = (0..200).map(|_| Ok(vec![0x55; READ])).collect();
        let threads = threads(Device { says: Mutex::new(says), ..Device::default() });
        let begun = Instant::now();
        while threads.shared.queues().incoming.len() <= INCOMING {
            assert!(begun.elapsed() < LONG);
            thread::sleep(BREATH / 100);
        }
        let mut incoming = Vec::new();
        threads.exchange(&[], &mut incoming, LONG).unwrap();
        assert!(incoming.len() <= INCOMING + READ, "{}", incoming.len());
        while incoming.len() < 200 * READ {
            threads.exchange(&[], &mut incoming, LONG).unwrap();
        }
    }
}
