//! What is said, in each language.

use halfrow::progress::{JudgedAtSpeed, Step};
use serde_json::json;

use super::*;
use crate::floor::{Refusal, ScanError};
use crate::lane::Doing;
use crate::record::{StepOutcome, TEST_AGAIN};
use crate::said::Saying;
use crate::web::language::of;

fn german(said: &Said) -> (String, Option<&'static str>) {
    let Sentence { text, foreign } = of(Some("de"), None).tell(said);
    (text, foreign)
}

#[test]
fn what_has_a_code_is_said_in_the_language_with_its_figures_and_causes() {
    let lane = "3".to_owned();
    let out = ScanError::Lane(Refusal::Out { lane, why: Saying::OutByPerson.into() });
    let told = "Platz 3 ist gesperrt: von Hand; mit HR:IN entsperren oder anderen Platz nehmen";
    assert_eq!(german(&Said::of(&out)), (told.to_owned(), None));
    let text = "lane 3 is out of service: taken out by hand; put it back with HR:IN, or take another lane";
    assert_eq!(of(None, None).tell(&Said::of(&out)).text, text);
    let seconds = Said::from(Saying::LaneSilent { seconds: 2.5 });
    assert_eq!(german(&seconds).0, "der Prozess des Platzes meldete 2,5 s lang nichts");
}

/// In every language what to do is separated from the rest, and a finding's figures stay whole.
#[test]
fn what_is_asked_for_is_told_apart_from_why() {
    let text = |told: Option<Sentence>| told.map(|told| (told.text, told.foreign));
    let due = Said::from(Saying::MockDue { barcode: "HR:MOCK".to_owned() });
    for (language, asked) in [("en", "Scan HR:MOCK"), ("de", "Scannen Sie HR:MOCK"), ("zh", "请扫描 HR:MOCK")]
    {
        let (why, told) = of(Some(language), None).parted(&due, None);
        assert_eq!(text(told), Some((asked.to_owned(), None)));
        assert!(!why.text.contains("HR:MOCK") && !why.text.ends_with([';', '；', ' ']), "{why:?}");
    }
    let (why, told) = of(None, None).parted(&Saying::OutByPerson.into(), None);
    assert_eq!((why.text.as_str(), told), ("taken out by hand", None));
    let said = |code: &str, message: &str, parameters: Value| Said {
        message: message.to_owned(),
        ..judged(code, &parameters)
    };
    let cause =
        said("link-closed", "it was closed; check the cable", json!({ "link": "usb:1", "at": 11.069_952 }));
    let broke = Said { causes: vec![cause], ..said("link-broke", "the link broke", json!({})) };
    let (why, told) = of(Some("de"), None).parted(&broke, Some("Check the cable."));
    assert_eq!(why.text, "die Verbindung brach ab: usb:1 wurde nach 11,1 s geschlossen");
    let asked = "Kabel und Stromversorgung der Platine prüfen, dann noch einmal";
    assert_eq!(text(told), Some((asked.to_owned(), None)));
    let named = said("of-tomorrow", "there is no unit CA1; CA2", json!({ "serial": "CA1; CA2" }));
    let (why, told) = of(None, None).parted(&named, None);
    assert_eq!(
        (why.text.as_str(), told),
        ("there is no unit CA1; CA2", None),
        "part of a name asks for nothing"
    );
    let lost = said("row-lost-once", "a row was lost; it is row 3", json!({}));
    let (why, told) = of(None, None).parted(&lost, Some("Check the cable."));
    assert_eq!(
        (why.text.as_str(), told.unwrap().text.as_str()),
        ("a row was lost; it is row 3", "Check the cable")
    );
    let (_, told) = of(Some("de"), None).parted(&lost, Some("Check the cable."));
    assert_eq!(
        text(told),
        Some(("Kabel und Verbindung prüfen, dann die Platine noch einmal prüfen".to_owned(), None))
    );
}

#[test]
fn what_has_no_words_is_told_in_english_and_marked_so() {
    let new = Said { code: "of-tomorrow".to_owned(), ..Saying::OutByPerson.into() };
    assert_eq!(german(&new), ("taken out by hand".to_owned(), Some("en")));
    let cause = Said { message: "disk I/O error".to_owned(), code: "foreign-cause".to_owned(), ..new };
    let led = Said { causes: vec![cause], ..Saying::DeviceUnsaid.into() };
    assert_eq!(
        german(&led),
        ("die Platine nennt ihre Bausteinnummer nicht: disk I/O error".to_owned(), None)
    );
}

/// As the judge's reports write them: a finding within a finding, and a place with its parts.
#[test]
fn findings_within_findings_and_parts_of_a_figure_are_said_too() {
    let suspect = json!({ "code": "line-memory-data-stuck", "parameters": { "bit": 5, "value": 1 } });
    let differ = judged(
        "samples-differ",
        &json!({ "differences": 7, "samples": 99, "differing_frames": 1, "frames": 2, "suspect": suspect }),
    );
    let told = "7 von 99 Abtastwerten weichen ab, in 1 von 2 Bildern; Verdacht: Zeilenspeicher, Datenbit 5, hängt auf 1";
    assert_eq!(german(&differ).0, told);
    let mut in_rules = differ.clone();
    in_rules.parameters.insert("tried".to_owned(), json!({ "width": 14, "height": 3 }));
    let told = "7 von 99 Abtastwerten weichen ab, in Zeilen, an denen die Regeln des Protokolls geprüft wurden (14 x 3); Verdacht: ";
    assert!(german(&in_rules).0.starts_with(told), "{}", german(&in_rules).0);
    let late = judged("row-out-of-order", &json!({ "row": 14, "frame": 13, "rules": true }));
    let told = "die Platine ordnet Zeilen um: Zeile 14 von Bild 13 der Regeln kam hinter einer späteren";
    assert_eq!(german(&late).0, told);
    let asked = of(Some("de"), None).remedy(Some(&differ), "in English");
    assert!(asked.text.starts_with("Bitstream neu laden") && asked.foreign.is_none(), "{asked:?}");
    let doubted = judged(
        "wrong-over-doubtful-link",
        &json!({
            "found": { "code": "table-crc-wrong", "parameters": {} },
            "doubt": { "of": "requests-twice", "requests": 1 },
        }),
    );
    let link = "Kabel und Verbindung prüfen, dann die Platine noch einmal prüfen";
    assert_eq!(of(Some("de"), None).remedy(Some(&doubted), "in English").text, format!("{link}."));
    let doubted = Said { message: "it may be; check the link, and run again".to_owned(), ..doubted };
    let (why, asked) = of(Some("de"), None).parted(&doubted, Some("Check the link, and run again."));
    assert!(why.text.ends_with("das kann von der Verbindung kommen"), "{why:?}");
    assert_eq!(asked.unwrap().text, link);
    let missing = judged("row-missing", &json!({ "place": { "frame": 2, "row": 3 }, "attempts": 8 }));
    assert_eq!(
        german(&missing).0,
        "Zeile 3 von Bild 2 kam in 8 Versuchen nicht zurück; mit `halfrow verify` feststellen, ob Platine oder Verbindung sie verliert"
    );
    assert_eq!(of(Some("de"), None).remedy(None, "Look.").foreign, Some("en"));
}

fn judged(code: &str, parameters: &Value) -> Said {
    let parameters = parameters.as_object().cloned().unwrap_or_default();
    Said { code: code.to_owned(), parameters, message: "in English".to_owned(), causes: Vec::new() }
}

/// After a run that ended early nobody has looked into the difference, and no code's own sentence has room for it.
#[test]
fn samples_that_differed_by_the_end_of_a_run_are_told_in_every_language() {
    let differed = json!({ "differences": 12_345, "samples": 40_960, "differing_frames": 3, "frames": 8 });
    let stopped = judged("stopped-by-signal", &json!({ "by": "stopped by hand", "differed": differed }));
    let told = "12.345 von 40.960 Abtastwerten weichen ab, in 3 von 8 Bildern, und der Lauf brach ab, bevor das untersucht wurde: \
                abgebrochen, die Platine ist nicht beurteilt; noch einmal prüfen";
    assert_eq!(german(&stopped), (told.to_owned(), None));
    let chinese = of(Some("zh"), None).tell(&stopped);
    assert_eq!(
        (chinese.text.as_str(), chinese.foreign),
        (
            "40,960 个样值中 12,345 个不同，涉及 8 帧中的 3 帧，测试在查明之前中断：已中止，该板未被判定；请重新测试",
            None
        )
    );
}

/// As their links call themselves: the one of a socket is asked here, the other one is what `halfrow verify` prints.
#[test]
fn the_names_of_links_are_told_in_the_language() {
    let listening = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let at = listening.local_addr().unwrap();
    let link = halfrow::link::open(&format!("tcp:{at}").parse().unwrap()).unwrap().link;
    let told = |language, code: &str, link: &str| {
        let told = of(Some(language), None).tell(&judged(code, &json!({ "link": link, "at": 11.069_952 })));
        assert_eq!(told.foreign, None);
        told.text.split([';', '；']).next().unwrap().to_owned()
    };
    let [socket, serial] = [link.name(), "the serial port /dev/ttyUSB0 (115200 baud)".to_owned()];
    for (language, code, name, text) in [
        ("de", "link-closed", &socket, format!("die Verbindung zu {at} wurde nach 11,1 s geschlossen")),
        ("de", "link-without-board", &socket, format!("die Verbindung zu {at} führt zu keiner Platine")),
        (
            "de",
            "link-failed",
            &serial,
            "der serielle Anschluss /dev/ttyUSB0 (115200 Baud) fiel nach 11,1 s aus".to_owned(),
        ),
        ("zh", "link-closed", &socket, format!("连接 {at} 在 11.1 秒时关闭")),
        ("zh", "link-without-board", &socket, format!("连接 {at} 后面没有板卡")),
        ("zh", "link-failed", &serial, "115200 波特的串口 /dev/ttyUSB0 在 11.1 秒时故障".to_owned()),
        ("de", "link-closed", &"usb:1".to_owned(), "usb:1 wurde nach 11,1 s geschlossen".to_owned()),
        ("zh", "link-closed", &"usb:1".to_owned(), "usb:1 在 11.1 秒时关闭".to_owned()),
    ] {
        assert_eq!(told(language, code, name), text);
    }
}

/// That the board counts the row shows that it, and no cable, lost it.
#[test]
fn a_swallowed_row_is_told_with_what_shows_that_the_board_lost_it() {
    let swallowed = judged("row-swallowed", &json!({ "row": 16, "frame": 0, "again": 17 }));
    for (language, end) in [
        ("de", "ging nur Zeile 17 verloren, obwohl die Platine sie als empfangen zählt"),
        ("zh", "只有第 17 行丢失，而板卡将其计为已收到"),
    ] {
        let told = of(Some(language), None).tell(&swallowed).text;
        assert!(told.ends_with(end), "{told}");
    }
}

/// A bit that is one of several alike, and a suspect that is one of several; records of earlier programs have neither.
#[test]
fn what_is_one_of_several_is_not_told_as_the_fact_in_any_language() {
    let told = |language, said: &Said| of(Some(language), None).tell(said).text;
    let bit =
        |reading: Value| judged("row-factor-bit-wrong", &json!({ "row": 3, "bit": 6, "reading": reading }));
    let several = bit(json!({ "alike": [9, 5] }));
    assert_eq!(told("de", &several), "Zeilenfaktor 3, Bit 5, 6 oder 9");
    assert_eq!(told("zh", &several), "行系数 3，第 5、6 或 9 位");
    assert_eq!(told("de", &bit(json!({}))), "Zeilenfaktor 3, Bit 6");
    let suspect = json!({ "code": "output-data-stuck", "parameters": { "bit": 9, "value": 1 } });
    for code in ["samples-differ", "differs-at-speed"] {
        for (others, german, chinese) in [
            (json!(1), "auf 1, oder ein anderer Fehler, der dasselbe ergibt", "为 1，或另一个结果相同的缺陷"),
            (
                json!(3),
                "auf 1, oder einer von 3 anderen, die dasselbe ergeben",
                "为 1，或另外 3 个结果相同的缺陷之一",
            ),
            (json!(0), "hängt auf 1", "固定为 1"),
            (Value::Null, "hängt auf 1", "固定为 1"),
        ] {
            let mut said = judged(code, &json!({ "suspect": suspect, "others": others }));
            said.parameters.retain(|_, value| !value.is_null());
            for (language, end) in [("de", german), ("zh", chinese)] {
                assert!(told(language, &said).ends_with(end), "{}", told(language, &said));
            }
        }
    }
}

#[test]
fn one_late_row_is_told_as_one_and_rows_that_are_late_now_and_then_ask_for_a_look_at_the_timing() {
    let late = |rows: usize, of_rows: usize, is_one_row: bool| {
        let mut late =
            json!({ "rows": rows, "row": 3, "frame": 0, "first": 973, "last": 974, "claimed": 972 });
        if of_rows > 0 {
            (late["of_rows"], late["is_one_row"]) = (of_rows.into(), is_one_row.into());
        }
        judged("latency-wrong", &late)
    };
    let begins = |said: &Said| german(said).0.split_once(": ").unwrap().0.to_owned();
    let claims = "Zeilen haben eine andere Verzögerung, als die Platine angibt";
    assert_eq!(begins(&late(16, 96, true)), format!("16 von 96 {claims}, jedes Mal Zeile 3"));
    assert_eq!(begins(&late(7, 96, false)), format!("7 von 96 {claims}"));
    assert_eq!(begins(&late(7, 0, false)), format!("7 {claims}"));
    let asked = |language, said: &Said| of(Some(language), None).remedy(Some(said), "in English").text;
    for language in ["de", "zh"] {
        let [always, at_times] =
            ["latency-miscounted", "generation-wrong"].map(|code| asked(language, &judged(code, &json!({}))));
        assert!(always != at_times);
        for said in [late(96, 96, false), late(9, 0, false), late(16, 96, true)] {
            assert_eq!(asked(language, &said), always);
        }
        for said in [late(1, 96, true), late(7, 96, false)] {
            assert_eq!(asked(language, &said), at_times);
        }
    }
}

/// A technician is asked for the same as for a frame that was wrong at speed, and told what shows that a rule is broken.
#[test]
fn signatures_alone_ask_for_a_look_at_the_timing_and_for_the_rule_that_each_run_names() {
    let found = json!({ "other-signatures": { "frames": 2, "first": 0 } });
    let asked = |language, code, parameters: &Value| {
        of(Some(language), None).remedy(Some(&judged(code, parameters)), "in English").text
    };
    for (language, rule) in [("de", "dieselbe Regel"), ("zh", "同一条规则")] {
        let [broken, at_speed] =
            ["rule-broken", "differs-at-speed"].map(|code| asked(language, code, &json!({ "found": found })));
        let (begins, rest) = broken.split_at(at_speed.trim_end_matches(['.', '。']).len());
        assert_eq!(begins, at_speed.trim_end_matches(['.', '。']));
        assert!(rest.contains(rule), "{broken}");
        assert_ne!(asked(language, "rule-broken", &json!({ "found": { "taken": {} } })), broken);
    }
}

/// What the station itself asks for, also about boards that a plan refuses.
#[test]
fn what_the_station_asks_for_is_told_in_the_language() {
    let said: Said = Saying::OtherSerial { serial: "CA2".to_owned(), scanned: "CA9".to_owned() }.into();
    let asked = |language, said: &Said, recorded| {
        let (_, asked) = of(Some(language), None).parted(said, Some(recorded));
        let Sentence { text, foreign } = asked.unwrap();
        assert_eq!(foreign, None, "{text}");
        text
    };
    let recorded = said.remedy().unwrap();
    assert_eq!(
        asked("de", &said, recorded),
        "Etikett der Platine scannen, die auf dem Platz liegt; was repariert wurde, ordnet ein Ingenieur neu zu"
    );
    assert_eq!(asked("zh", &said, recorded), "请扫描工位上那块板卡的标签；维修过的板卡由工程师重新绑定");
    assert!(asked("en", &said, recorded).starts_with("Scan the label of the board that is in the lane;"));
    let died = Saying::LaneEndless.into();
    assert_eq!(asked("de", &died, TEST_AGAIN), "Platine noch einmal prüfen");
    assert_eq!(asked("zh", &died, TEST_AGAIN), "请重新测试该板");
}

/// As the judge counts frames at speed, and as a lane says how a step ended and which board it is.
#[test]
fn what_a_run_does_is_told_in_the_language_with_its_figures() {
    let told = |language, what: Doing| {
        let Sentence { text, foreign } = of(Some(language), None).doing(&what);
        (text, foreign)
    };
    let own = |text: &str| (text.to_owned(), None);
    let some = || Doing::AtSpeed(JudgedAtSpeed { frames: 2, of: 12 });
    assert_eq!(told("de", Doing::Judging(Step::AtSpeed)), own("Bilder mit vollem Pixeltakt"));
    assert_eq!(told("de", some()), own("Bilder mit vollem Pixeltakt: 2 von 12"));
    assert_eq!(told("zh", some()), own("全像素时钟下的帧：2/12"));
    assert_eq!(told("en", some()), own("frames at the full pixel clock: 2 of 12"));
    let ended = |step: &str, outcome| Doing::Ended { step: step.to_owned(), outcome };
    assert_eq!(told("de", ended("verify", StepOutcome::Failed)), own("verify: nicht bestanden"));
    assert_eq!(told("zh", ended("identity", StepOutcome::Passed)), own("identity：通过"));
    assert_eq!(told("de", Doing::Named("flat field".to_owned())), ("flat field".to_owned(), Some("en")));
    assert_eq!(told("de", Doing::Place("cam-1".to_owned())), own("wartet auf den Ort cam-1 von labgrid"));
    assert_eq!(told("zh", Doing::Place("cam-1".to_owned())), own("等待 labgrid 的位置 cam-1"));
}

#[test]
fn figures_are_written_as_the_language_writes_them() {
    let text = |language, said: &Said| of(Some(language), None).tell(said).text;
    let limit = |value: f64, unit: &str, high: Value| {
        judged(
            "measurement-beyond-limit",
            &json!({ "name": "n", "value": value, "unit": unit, "low": null, "high": high }),
        )
    };
    assert_eq!(
        text("de", &limit(172.0, "clocks", json!(100.0))),
        "n ist 172 Takte; untere Grenze: –, obere Grenze: 100"
    );
    assert_eq!(
        text("de", &limit(0.5, "us", json!(0.25))),
        "n ist 0,5 µs; untere Grenze: –, obere Grenze: 0,25"
    );
    assert_eq!(text("zh", &limit(0.0, "1", json!(5))), "n 为 0；下限：–，上限：5");
    let equal = judged("frames-equal", &json!({ "frames": 2, "samples": 384_000 }));
    assert_eq!(text("de", &equal), "2 Bilder, 384.000 Abtastwerte, alle gleich");
    assert_eq!(text("zh", &equal), "2 帧、384,000 个样值全部相同");
    let few = judged("frames-equal", &json!({ "frames": 2, "samples": 9_600 }));
    assert_eq!(text("de", &few), "2 Bilder, 9600 Abtastwerte, alle gleich");
    let named = judged("lane-unknown", &json!({ "lane": "9", "known": "1, 2, 3" }));
    assert_eq!(text("zh", &named), "没有工位 9；现有工位：1、2、3");
    let broke = judged("link-broke", &json!({}));
    let broke = Said { causes: vec![judged("serial-port-is-none", &json!({ "path": "p" }))], ..broke };
    assert_eq!(text("zh", &broke), "连接中断：p 不是串口；请用 `halfrow boards` 查看现有端口");
    let clock = json!({ "clock_hz": 96_000_000, "seen": { "least_hz": null, "most_hz": 48_000_000 } });
    let seen = "gesehen wurden mindestens – Hz, höchstens 48000000 Hz";
    assert!(text("de", &judged("clock-not-as-named", &clock)).ends_with(seen));
    let stuck = |table: &str| judged("table-data-stuck", &json!({ "table": table, "bit": 7, "value": 1 }));
    assert_eq!(text("de", &stuck("rows")), "Zeilentabelle, Datenbit 7, hängt auf 1");
    assert_eq!(text("zh", &stuck("kernel")), "核存储器，数据位 7，固定为 1");
}

/// Whoever reads of a PASS learns that no product was tested.
#[test]
fn that_no_hardware_was_tested_is_told_in_every_language() {
    let text = |language, board: &str| {
        let figures = json!({ "frames": 2, "samples": 9_600, "latency": 44, "board": board });
        of(Some(language), None).tell(&judged("all-right", &figures)).text
    };
    for (language, end) in
        [("de", " (Mock-Platine: keine Hardware geprüft)"), ("zh", "（模拟板：未测试硬件）")]
    {
        assert!(text(language, "mock").ends_with(end), "{}", text(language, "mock"));
        assert_eq!(format!("{}{end}", text(language, "hardware")), text(language, "mock"));
    }
    assert!(text("de", "replay").ends_with(" (Aufzeichnung: jetzt wurde keine Hardware geprüft)"));
}

/// In the words of the lane's state, and by the station's clock.
#[test]
fn a_verdict_and_an_hour_are_told_as_the_lane_says_them() {
    let text = |language, said: &Said| of(Some(language), None).tell(said).text;
    let wrong = judged("shift-good-unit-wrong", &json!({ "serial": "CC1", "verdict": "FAIL" }));
    assert!(text("de", &wrong).starts_with("die Gutplatine CC1 ergab SCHLECHT; "), "{}", text("de", &wrong));
    assert!(text("zh", &wrong).starts_with("合格样板 CC1 的结果是“不合格”；"), "{}", text("zh", &wrong));
    let when = "2026-11-27T16:48:24+01:00";
    let passed = judged("unit-passed-already", &json!({ "serial": "CC1", "when": when }));
    let here = crate::clock::local(1_795_794_504_000).strftime("%Y-%m-%d %H:%M %:z");
    assert!(text("de", &passed).contains(&format!("bestanden, {here}; ")), "{}", text("de", &passed));
}

/// For errors that end in what to do, as records keep them.
#[test]
fn what_an_error_asks_for_is_told_in_the_language() {
    for (code, parameters, message) in [
        (
            "row-missing",
            json!({ "place": { "frame": 2, "row": 3 }, "attempts": 8 }),
            "a row is lost; let it tell",
        ),
        ("stopped-by-signal", json!({}), "stopped by hand, and the board is not judged; let it tell"),
        ("board-process-stopped", json!({ "board": "b", "at": 1.0 }), "b stopped; let it tell"),
    ] {
        let said = Said { message: message.to_owned(), ..judged(code, &parameters) };
        for language in ["de", "zh"] {
            let (why, asked) = of(Some(language), None).parted(&said, Some("Let it tell."));
            let asked = asked.unwrap();
            assert!(why.foreign.is_none() && asked.foreign.is_none(), "{code}: {why:?} {asked:?}");
        }
    }
}
