//! Transfers to one interface of a USB device. Ways of transfer other than libusb's blocking calls, and chips other than FTDI's,
//! would be added here.

use std::time::Duration;

use rusb::{Context, Device, DeviceHandle};

/// A transfer over USB failed, and the cause is the USB driver's own error.
#[derive(Debug, Clone, thiserror::Error)]
pub enum UsbFailure {
    /// The device is gone.
    #[error("the device is gone")]
    Gone,
    /// The device refuses the request.
    #[error("the device refuses the request")]
    Refused,
    /// It took too long.
    #[error("no answer in time")]
    Late,
    /// Anything else.
    #[error("{0}")]
    Other(String),
}

/// What the bytes go through. Several threads may call it at the same time.
pub(crate) trait Transport: Send + Sync {
    /// Bytes of a full packet to the host, if the device says it.
    fn packet(&self) -> Option<usize>;

    /// A vendor request to the device.
    ///
    /// # Errors
    /// [`UsbFailure`]
    fn request(&self, request: u8, value: u16, index: u16) -> Result<(), UsbFailure>;

    /// A vendor request for two bytes, little endian.
    ///
    /// # Errors
    /// [`UsbFailure`], also when fewer bytes come.
    fn request_word(&self, request: u8, value: u16, index: u16) -> Result<u16, UsbFailure>;

    /// Reads a transfer, which ends with a packet that is not full or with the buffer, whose length is a multiple of 512. If
    /// nothing comes within `wait` it returns 0.
    ///
    /// # Errors
    /// [`UsbFailure`]
    fn read(&self, buffer: &mut [u8], wait: Duration) -> Result<usize, UsbFailure>;

    /// Writes what goes out within `wait`, and returns the number of bytes.
    ///
    /// # Errors
    /// [`UsbFailure`]
    fn write(&self, bytes: &[u8], wait: Duration) -> Result<usize, UsbFailure>;
}

/// The limit for a request. The chip answers within a frame.
const REQUEST: Duration = Duration::from_millis(500);

const VENDOR_OUT: u8 = 0x40;
const VENDOR_IN: u8 = 0xc0;

/// An interface that libusb has claimed.
pub(super) struct Libusb {
    handle: DeviceHandle<Context>,
    interface: u8,
    endpoint_in: u8,
    endpoint_out: u8,
    packet: Option<usize>,
}

impl Libusb {
    /// Claims only `interface`. The kernel's driver is detached from it, and reattached when this is dropped.
    pub(super) fn claim(
        handle: DeviceHandle<Context>,
        interface: u8,
        (endpoint_in, endpoint_out): (u8, u8),
    ) -> Result<Self, rusb::Error> {
        match handle.set_auto_detach_kernel_driver(true) {
            // NotSupported: a system without such drivers.
            Ok(()) | Err(rusb::Error::NotSupported) => {}
            Err(error) => return Err(error),
        }
        handle.claim_interface(interface)?;
        let packet = packet_of(&handle.device(), endpoint_in);
        Ok(Self { handle, interface, endpoint_in, endpoint_out, packet })
    }
}

/// What the device's descriptor says about `endpoint`. Some chips say 0 there (Linux's ftdi_sio.c, ftdi_set_max_packet_size).
fn packet_of(device: &Device<Context>, endpoint: u8) -> Option<usize> {
    let configuration = device.active_config_descriptor().ok()?;
    let mut settings = configuration.interfaces().flat_map(|interface| interface.descriptors());
    let size = settings.find_map(|setting| {
        let mut endpoints = setting.endpoint_descriptors();
        endpoints.find(|found| found.address() == endpoint).map(|found| found.max_packet_size())
    });
    size.map(usize::from).filter(|&size| size > 0)
}

impl Drop for Libusb {
    fn drop(&mut self) {
        // A device that is gone has nothing to release.
        let _ = self.handle.release_interface(self.interface);
    }
}

impl Transport for Libusb {
    fn packet(&self) -> Option<usize> {
        self.packet
    }

    fn request(&self, request: u8, value: u16, index: u16) -> Result<(), UsbFailure> {
        self.handle.write_control(VENDOR_OUT, request, value, index, &[], REQUEST).map(drop).map_err(failure)
    }

    fn request_word(&self, request: u8, value: u16, index: u16) -> Result<u16, UsbFailure> {
        let mut word = [0; 2];
        let read = self.handle.read_control(VENDOR_IN, request, value, index, &mut word, REQUEST);
        match read.map_err(failure)? {
            2 => Ok(u16::from_le_bytes(word)),
            read => Err(UsbFailure::Other(format!("{read} of 2 bytes came"))),
        }
    }

    fn read(&self, buffer: &mut [u8], wait: Duration) -> Result<usize, UsbFailure> {
        in_time(self.handle.read_bulk(self.endpoint_in, buffer, whole_milliseconds(wait)))
    }

    fn write(&self, bytes: &[u8], wait: Duration) -> Result<usize, UsbFailure> {
        in_time(self.handle.write_bulk(self.endpoint_out, bytes, whole_milliseconds(wait)))
    }
}

/// libusb counts in milliseconds, and takes 0 for no limit.
fn whole_milliseconds(wait: Duration) -> Duration {
    wait.max(Duration::from_millis(1))
}

/// What moved before the time was over counts.
fn in_time(moved: Result<usize, rusb::Error>) -> Result<usize, UsbFailure> {
    match moved {
        Err(rusb::Error::Timeout | rusb::Error::Interrupted) => Ok(0),
        moved => moved.map_err(failure),
    }
}

pub(super) fn failure(error: rusb::Error) -> UsbFailure {
    match error {
        rusb::Error::NoDevice | rusb::Error::NotFound => UsbFailure::Gone,
        rusb::Error::Pipe => UsbFailure::Refused,
        rusb::Error::Timeout => UsbFailure::Late,
        // A device that was pulled out in the middle of a transfer.
        rusb::Error::Io => UsbFailure::Gone,
        other => UsbFailure::Other(other.to_string()),
    }
}
