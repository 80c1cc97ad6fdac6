//! Translates the Verilog in `fpga/rtl` to C++ with Verilator and compiles it, once for every build of the design that the
//! crate offers.

use std::env;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, exit};

/// A top module with its parameters.
struct Model {
    /// The C++ class that Verilator makes of it.
    class: &'static str,
    /// Its name in src/ffi.rs, after `halfrow_`.
    name: &'static str,
    top: Top,
    parameters: &'static [&'static str],
}

/// A top module.
struct Top {
    module: &'static str,
    /// The header in `shim` that describes its ports.
    ports: &'static str,
}

const BRIDGE: Top = Top { module: "halfrow_bridge", ports: "bridge.h" };
const UART: Top = Top { module: "halfrow_uart_bridge", ports: "uart.h" };
const FIFO: Top = Top { module: "halfrow_fifo_bridge", ports: "fifo.h" };
const CORE: Top = Top { module: "halfrow_core", ports: "core.h" };

const BOARDS: [Model; 3] = [
    Model { class: "Bridge", name: "bridge", top: BRIDGE, parameters: &[] },
    Model { class: "UartBridge", name: "uart", top: UART, parameters: &[] },
    Model { class: "FifoBridge", name: "fifo", top: FIFO, parameters: &[] },
];

/// Models that only tests need.
const BUILDS: [Model; 7] = [
    Model { class: "Core7", name: "core7", top: CORE, parameters: &["TAPS=7"] },
    Model { class: "Core5", name: "core5", top: CORE, parameters: &["TAPS=5"] },
    Model { class: "CoreShort", name: "core_short", top: CORE, parameters: &["TAPS=7", "RING_BITS=7"] },
    Model { class: "CoreShort5", name: "core_short5", top: CORE, parameters: &["TAPS=5", "RING_BITS=7"] },
    Model {
        class: "BridgeFour",
        name: "bridge_four",
        top: BRIDGE,
        parameters: &["ROW_BANKS_IN=4", "ROW_BANKS_OUT=4"],
    },
    Model { class: "BridgeIn", name: "bridge_in", top: BRIDGE, parameters: &["ROW_BANKS_IN=4"] },
    Model {
        class: "BridgeLean",
        name: "bridge_lean",
        top: BRIDGE,
        parameters: &["ROW_BANKS_IN=4", "ROW_BANKS_OUT=4", "TABLE_BANKS=1", "TAPS=5", "TRAP=0"],
    },
];

/// The parameters of every simulated board, one a line; boards with faults in them have the same (fpga/checks/coverage.py).
const PARAMETERS: &str = include_str!("parameters.txt");
/// The name that it reports.
const NAME: &str = "NAME=\"halfrow simulated board\"";

const REMEDY: &str = "install it with `apt-get install verilator g++`, or build without `--features sim`";
const NEWER: &str = "Debian 12 and Ubuntu 24.04 have 5; name another in the variable `VERILATOR`, or build without `--features sim`";

fn main() {
    let folder = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let rtl = folder.join("../rtl");
    println!("cargo::rerun-if-changed={}", rtl.display());
    println!("cargo::rerun-if-changed=shim");
    println!("cargo::rerun-if-env-changed=VERILATOR");
    println!("cargo::rerun-if-env-changed=HALFROW_UNLINKED");
    // A run that only reads the sources, such as clippy's, needs nothing that takes minutes to compile.
    if env::var_os("HALFROW_UNLINKED").is_some() {
        return;
    }
    let verilator = Verilator::find();
    let out = PathBuf::from(env::var_os("OUT_DIR").unwrap_or_default());
    let all = env::var_os("CARGO_FEATURE_BUILDS").is_some();
    let models: Vec<_> = BOARDS.iter().chain(BUILDS.iter().filter(|_| all)).collect();
    for (place, model) in models.iter().enumerate() {
        verilator.translate(model, place < BOARDS.len(), &rtl, &out.join(model.class));
    }
    verilator.compile(&models, &out);
}

/// The Verilator of this machine.
struct Verilator {
    program: String,
    /// The folder with the library that its models are linked with.
    include: PathBuf,
}

impl Verilator {
    fn find() -> Self {
        let program = env::var("VERILATOR").unwrap_or_else(|_| "verilator".to_owned());
        let version = said(Command::new(&program).arg("--version"));
        let version = version.unwrap_or_else(|| fail(&format!("`{program}` cannot be run; {REMEDY}")));
        // Verilator 5.006 2023-01-22 rev (Debian 5.006-3)
        let number = version.split_whitespace().nth(1).unwrap_or_default();
        if !number.starts_with("5.") {
            fail(&format!("Verilator 5 is needed, and `{program}` is {number}; {NEWER}"));
        }
        let root = said(Command::new(&program).args(["--getenv", "VERILATOR_ROOT"]));
        let root = root.unwrap_or_else(|| fail(&format!("`{program}` does not know its VERILATOR_ROOT")));
        Self { program, include: Path::new(root.trim()).join("include") }
    }

    /// Translates one model into `folder`. If it `is_traced`, it gets what a waveform needs, which is more code than all the
    /// rest.
    fn translate(&self, model: &Model, is_traced: bool, rtl: &Path, folder: &Path) {
        // Files of a module that no longer exists would be compiled as well.
        let _ = fs::remove_dir_all(folder);
        let mut command = Command::new(&self.program);
        command.args(["--cc", "-O3", "--x-assign", "fast", "--x-initial", "unique", "-Wno-fatal"]);
        command.args(is_traced.then_some("--trace"));
        command.args(["--top-module", model.top.module, "--prefix", model.class]).arg("--Mdir").arg(folder);
        command.args(model.parameters.iter().map(|parameter| format!("-G{parameter}")));
        if model.top.module != CORE.module {
            command.args(PARAMETERS.lines().chain([NAME]).map(|parameter| format!("-G{parameter}")));
            command.arg(format!("-GBUILD=32'h{:08x}", checksum(rtl)));
        }
        command.arg(format!("-I{}", rtl.display()));
        for group in folders(rtl) {
            command.arg("-y").arg(&group);
            let top = group.join(model.top.module).with_extension("v");
            if top.exists() {
                command.arg(top);
            }
        }
        match command.output() {
            Ok(output) if output.status.success() => {}
            Ok(output) => fail(&format!("{command:?} failed:\n{}", String::from_utf8_lossy(&output.stderr))),
            Err(error) => fail(&format!("{command:?} failed: {error}")),
        }
    }

    fn compile(&self, models: &[&Model], out: &Path) {
        let (mut often, mut seldom) = (Vec::new(), Vec::new());
        for model in models {
            let (slow, fast): (Vec<_>, Vec<_>) =
                cpp_files(&out.join(model.class)).into_iter().partition(|file| runs_seldom(file));
            // In one unit with its caller, the parts of a model are inlined into each other.
            let design = format!("DESIGN({}, {})", model.name, model.class);
            often.push(unit(out, model.class, &[&[model.top.ports.into()], &fast[..]].concat(), &design));
            seldom.push(unit(out, &format!("{}Seldom", model.class), &slow, ""));
        }
        for file in ["verilated.cpp", "verilated_threads.cpp", "verilated_vcd_c.cpp"] {
            often.push(self.include.join(file));
        }
        // More makes no model faster, and doubles the time that compiling takes.
        self.compiler(models, out).opt_level(1).files(often).compile("halfrow_designs");
        self.compiler(models, out).opt_level(0).files(seldom).compile("halfrow_designs_seldom");
        println!("cargo::rustc-link-lib=pthread");
    }

    fn compiler(&self, models: &[&Model], out: &Path) -> cc::Build {
        let mut build = cc::Build::new();
        build.cpp(true).std("c++17").debug(false).warnings(false).define("VL_TIME_CONTEXT", None);
        // Nothing replaces a function of this library, so functions may be inlined although the code is position-independent.
        build.flag_if_supported("-fno-semantic-interposition");
        build.define("VM_TRACE", "1").define("VM_TRACE_VCD", "1").define("VM_TRACE_FST", "0");
        build.include(&self.include).include(self.include.join("vltstd")).include("shim");
        for model in models {
            build.include(out.join(model.class));
        }
        build
    }
}

/// Writes the source `name` to `out`: it includes these files and ends with `last`.
fn unit(out: &Path, name: &str, files: &[PathBuf], last: &str) -> PathBuf {
    let includes = files.iter().map(|file| format!("#include \"{}\"\n", file.display()));
    let unit = out.join(name).with_extension("cpp");
    let text = includes.collect::<String>() + last + "\n";
    if let Err(error) = fs::write(&unit, text) {
        fail(&format!("{} cannot be written: {error}", unit.display()));
    }
    unit
}

/// What is in a folder.
fn entries(within: &Path) -> Vec<PathBuf> {
    let read = || -> io::Result<Vec<_>> { fs::read_dir(within)?.map(|entry| Ok(entry?.path())).collect() };
    read().unwrap_or_else(|error| fail(&format!("{} cannot be read: {error}", within.display())))
}

/// The folders in a folder, sorted by name.
fn folders(within: &Path) -> Vec<PathBuf> {
    let mut folders: Vec<_> = entries(within).into_iter().filter(|path| path.is_dir()).collect();
    folders.sort();
    folders
}

/// The CRC-32 of the Verilog and of the parameters, which identifies a simulated board's build (fpga/checks/table.py).
fn checksum(rtl: &Path) -> u32 {
    let folders = folders(rtl);
    let mut files: Vec<_> = folders.iter().map(PathBuf::as_path).chain([rtl]).flat_map(entries).collect();
    files.retain(|path| path.extension().is_some_and(|kind| kind == "v" || kind == "vh"));
    files.sort();
    let mut checksum = crc32fast::Hasher::new();
    for file in &files {
        let text = fs::read(file)
            .unwrap_or_else(|error| fail(&format!("{} cannot be read: {error}", file.display())));
        checksum.update(&text);
    }
    checksum.update(PARAMETERS.as_bytes());
    checksum.finalize()
}

/// What a command prints, if it runs and succeeds.
fn said(command: &mut Command) -> Option<String> {
    let output = command.output().ok().filter(|output| output.status.success())?;
    String::from_utf8(output.stdout).ok()
}

/// Whether this is a file in which Verilator keeps code that runs only at the start or for a waveform.
fn runs_seldom(file: &Path) -> bool {
    let name = file.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    name.contains("__Slow") || name.contains("__Trace")
}

fn cpp_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = entries(folder);
    files.retain(|path| path.extension().is_some_and(|found| found == "cpp"));
    files.sort();
    files
}

fn fail(why: &str) -> ! {
    println!("cargo::error=halfrow-sim: {why}");
    exit(1)
}
