//! `halfrow-station rebind`

use std::path::PathBuf;

use clap::Args;

use super::why::{Why, at_station};
use super::{Failure, tell_lines};
use crate::exit::Exit;
use crate::store::{Change, Folder, RebindError, is_device};

/// Say that a serial number has another device from now on
///
/// For boards that were repaired, and for labels that were exchanged. Who, when and why are kept.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The station's folder
    #[arg(long, value_name = "FOLDER", env = "HALFROW_STATION_DATA")]
    data: PathBuf,
    /// The board's serial number
    #[arg(long)]
    serial: String,
    /// The number of its FPGA, 16 hexadecimal digits [default: that of the board that is judged next]
    #[arg(long, value_name = "DEVICE", value_parser = device)]
    device: Option<String>,
    /// Its product, where several have such a serial number
    #[arg(long)]
    product: Option<String>,
    #[command(flatten)]
    why: Why,
}

fn device(text: &str) -> Result<String, String> {
    let says = "give 16 hexadecimal digits in lower case, not all 0, as a run prints them after `device`";
    if is_device(text) { Ok(text.to_owned()) } else { Err(says.to_owned()) }
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let Arguments { data, serial, device, product, why: Why { reason, operator } } = arguments;
    let mut store = at_station(&Folder::new(data), operator, &format!("rebind {serial}"))?;
    let change = Change { serial, product: product.as_deref(), device: device.as_deref(), operator, reason };
    let bound = store.rebind(&change)?;
    let from_now = device.as_deref().map_or_else(
        || "is bound to the device of the next board that is judged under it".to_owned(),
        |device| format!("is bound to device {device}"),
    );
    Ok(tell_lines([format!("{serial} {from_now}"), format!("audit     {}, by {operator}", bound.id)]))
}

impl From<RebindError> for Failure {
    fn from(error: RebindError) -> Self {
        match error {
            RebindError::Store(error) => error.into(),
            RebindError::UnderTest { .. } => Self::error(error),
            RebindError::Unknown { .. } | RebindError::Several { .. } | RebindError::NoDevice { .. } => {
                Self::call(error)
            }
        }
    }
}
