//! The kernel's own driver and the emulated FT2232H understand each other, so that the chip is not one that only this
//! project's link believes in.

use std::fs::OpenOptions;
use std::io::{Read as _, Write as _};
use std::process::Command;
use std::thread;

use halfrow_ft2232h::{Chip, Loopback, Plugged};
use halfrow_tests::usb::{serial_port, uart};

#[test]
#[ignore = "needs scripts/in-linux"]
fn bytes_go_through_the_driver_and_back() {
    let board = Plugged::new(Chip::new(uart(), Box::new(Loopback::default())), 0).unwrap();
    let port = serial_port(&board, 1);
    let mut stty = Command::new("/bin/stty");
    stty.arg("-F").arg(&port).args(["raw", "-echo", "3000000", "crtscts"]);
    assert!(stty.status().unwrap().success());
    let port = OpenOptions::new().read(true).write(true).open(port).unwrap();
    let sent: Vec<u8> = (0..20_000_u32).map(|n| (n.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    let mut came = vec![0; sent.len()];
    thread::scope(|scope| {
        scope.spawn(|| (&port).write_all(&sent).unwrap());
        (&port).read_exact(&mut came).unwrap();
    });
    assert!(came == sent);
}
