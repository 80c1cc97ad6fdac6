//! FTDI's chips on USB, whether or not the system has made serial ports of them.

use super::{Access, Found};
use crate::access::Kept;
use crate::target::BoardKind;
use crate::{UsbBoard, usb_boards};

/// The FTDI chips on the USB of this computer.
pub(crate) fn find() -> Vec<Found> {
    let boards = usb_boards().unwrap_or_else(|error| {
        tracing::info!("{error}");
        Vec::new()
    });
    boards.iter().map(|board| look_at(board, board.target(&boards))).collect()
}

fn look_at(board: &UsbBoard, target: String) -> Found {
    Found {
        target,
        kind: BoardKind::Hardware,
        summary: board.to_string(),
        access: access_to(board),
        device: Some(board.file.clone()),
        names: Vec::new(),
        usb: Some(board.device.clone()),
        answer: None,
    }
}

fn access_to(board: &UsbBoard) -> Access {
    if let Some(kept) = Kept::is(&board.file) {
        return Access::Denied { remedy: kept.remedy(&board.file, Some(&board.device)) };
    }
    board.holders().map_or(Access::Free, |holders| Access::Busy { holders })
}
