//! What is wrong in a table or kernel file is named with its place and a remedy.

use halfrow::tables::{ContentError, KernelFile, Place, TableFile};
use serde_json::{Value, json};

/// A legal table file of four rows.
fn legal() -> Value {
    json!({
        "datapath": 1, "width": 64, "height": 4, "bits": 12, "centre2": 63,
        "step": [14_648_488, 16_777_215, 16_777_216, 1],
        "kernel": vec![[0, -2304, 2560, -768, 0]; 65],
    })
}

/// The refusal of the legal file after `change`.
fn refusal(change: impl FnOnce(&mut Value)) -> ContentError {
    let mut value = legal();
    TableFile::parse(&value.to_string()).unwrap();
    change(&mut value);
    TableFile::parse(&value.to_string()).unwrap_err()
}

#[track_caller]
fn says(refused: &ContentError, sentence: &str) {
    assert_eq!(refused.to_string(), sentence);
}

#[test]
fn a_file_that_breaks_off_gives_line_and_column() {
    let refused = TableFile::parse("{\n  \"datapath\": 1,\n  \"step\": [16777216, 1677").unwrap_err();
    assert!(matches!(refused, ContentError::Truncated { line: 3, column: 25 }), "{refused:?}");
    says(&refused, "it breaks off at line 3, column 25; copy or make the file again");
}

#[test]
fn text_that_is_no_json_gives_line_and_column() {
    let refused = TableFile::parse("{\n  \"datapath\": 1,\n  \"step\": [16777216 1]}").unwrap_err();
    assert!(matches!(refused, ContentError::Json { line: 3, column: 21, .. }), "{refused:?}");
    says(&refused, "it is not the JSON object it should be at line 3, column 21; mend it there");
}

#[test]
fn json_that_is_no_object_is_refused() {
    for text in ["[]", "12", "null", "\"step\"", "{} {}"] {
        let refused = TableFile::parse(text).unwrap_err();
        assert!(matches!(refused, ContentError::Json { line: 1, .. }), "{text}: {refused:?}");
    }
}

#[test]
fn nesting_without_end_is_refused() {
    let deep = format!("{{\"about\": {}", "[".repeat(100_000));
    assert!(matches!(TableFile::parse(&deep), Err(ContentError::Json { .. })));
}

#[test]
fn another_datapath_is_told_before_anything_else() {
    for id in [0, 3, 65536, -1] {
        let refused = TableFile::parse(&json!({"datapath": id, "rows": []}).to_string()).unwrap_err();
        assert!(matches!(&refused, ContentError::Datapath(wrong) if wrong.found == id.into()), "{refused:?}");
    }
    let refused = KernelFile::parse(r#"{"datapath": 3}"#).unwrap_err();
    says(
        &refused,
        "the tables are for datapath 3, and this program knows 1 and 2 alone; make them again with `halfrow tables`, \
         or use a halfrow that knows datapath 3",
    );
}

#[test]
fn an_unknown_key_is_named_with_those_that_there_are() {
    let refused = refusal(|file| file["steps"] = json!([]));
    assert!(matches!(&refused, ContentError::UnknownKey { key, .. } if key == "steps"));
    says(
        &refused,
        "it has the key \"steps\", and the keys are datapath, about, width, height, bits, centre2, step, kernel; \
         correct or remove it, or put notes into `about`",
    );
}

#[test]
fn a_kernel_file_has_no_geometry() {
    let refused = KernelFile::parse(&legal().to_string()).unwrap_err();
    assert!(matches!(&refused, ContentError::UnknownKey { key, .. } if key == "width"), "{refused:?}");
}

#[test]
fn a_long_foreign_key_is_cut_short() {
    let refused = refusal(|file| file["\u{1b}[2J".repeat(1000)] = json!(1));
    assert!(refused.to_string().len() < 300, "{refused}");
    assert!(!refused.to_string().contains('\u{1b}'), "{refused}");
}

#[test]
fn a_key_that_is_there_twice_is_named() {
    let text = legal().to_string().replacen("{", "{\"width\": 128, ", 1);
    let refused = TableFile::parse(&text).unwrap_err();
    assert!(matches!(&refused, ContentError::RepeatedKey { key } if key == "width"));
    says(&refused, "it has the key \"width\" twice; remove one");
}

#[test]
fn a_key_that_is_not_there_is_named() {
    for key in ["datapath", "width", "height", "bits", "centre2", "step", "kernel"] {
        let refused = refusal(|file| drop(file.as_object_mut().unwrap().remove(key)));
        assert!(matches!(refused, ContentError::MissingKey(place) if place.key() == key), "{refused:?}");
        assert!(refused.to_string().starts_with(&format!("it lacks `{key}`; give ")), "{refused}");
    }
}

#[test]
fn a_width_outside_the_datapaths_limits_is_refused() {
    for width in [0, 62, 2594, -64] {
        let refused = refusal(|file| file["width"] = json!(width));
        let sentence = "outside 64 to 2592; give the frame's columns, an even number";
        says(&refused, &format!("`width` is {width}, {sentence}"));
        assert!(matches!(refused, ContentError::Range { place: Place::Width, .. }));
    }
}

#[test]
fn an_odd_width_is_refused() {
    let refused = refusal(|file| file["width"] = json!(65));
    assert!(matches!(refused, ContentError::Geometry(_)));
    assert!(refused.to_string().starts_with("a width of 65 columns is not an even number"), "{refused}");
}

#[test]
fn a_height_outside_the_datapaths_limits_is_refused() {
    for height in [0, 2049] {
        let refused = refusal(|file| file["height"] = json!(height));
        says(&refused, &format!("`height` is {height}, outside 1 to 2048; give the frame's rows"));
        assert!(matches!(refused, ContentError::Range { place: Place::Height, .. }));
    }
}

#[test]
fn a_depth_that_the_datapath_does_not_have_is_refused() {
    let refused = refusal(|file| file["bits"] = json!(9));
    assert!(matches!(refused, ContentError::Bits { found: 9 }));
    says(&refused, "`bits` is 9; give 8, 10 or 12 bits a sample");
}

#[test]
fn a_centre_outside_the_frame_is_refused() {
    for centre2 in [-1, 127] {
        let refused = refusal(|file| file["centre2"] = json!(centre2));
        let remedy = "give twice the column of the optical centre, counted from 0";
        says(&refused, &format!("`centre2` is {centre2}, outside 0 to 126; {remedy}"));
    }
}

#[test]
fn missing_and_surplus_row_factors_are_counted() {
    let refused = refusal(|file| drop(file["step"].as_array_mut().unwrap().pop()));
    says(&refused, "`step` has 3 entries instead of 4; give one row factor for each row, from the top");
    let refused = refusal(|file| file["step"].as_array_mut().unwrap().push(json!(1)));
    assert!(matches!(refused, ContentError::Length { place: Place::RowFactors, found: 5, wanted: 4 }));
}

#[test]
fn a_row_factor_that_is_zero_or_too_large_is_named_with_its_row() {
    for (units, found) in [(json!(0), 0), (json!(16_777_217), 16_777_217), (json!(-5), -5)] {
        let refused = refusal(|file| file["step"][2] = units);
        says(
            &refused,
            &format!(
                "the row factor of row 2 is {found}, outside 1 to 16777216; a row factor is 2^24 / k, rounded, with a stretch \
                 factor k of at least 1"
            ),
        );
        assert!(matches!(refused, ContentError::Range { place: Place::RowFactor { row: 2 }, .. }));
    }
    let refused = refusal(|file| file["step"][0] = json!(u64::MAX));
    assert!(matches!(refused, ContentError::Range { found: 0xffff_ffff_ffff_ffff, .. }), "{refused:?}");
}

#[test]
fn a_weight_of_two_is_said_not_to_fit() {
    let refused = refusal(|file| file["kernel"][32][2] = json!(32768));
    let place = Place::Weight { node: 32, weight: "g4" };
    assert!(matches!(&refused, ContentError::Range { place: named, found: 32768, .. } if *named == place));
    says(
        &refused,
        "the weight g4 of node 32 is 32768, outside -32768 to 32767; weights count in 2^-14: 16384 is 1.0, and 2.0 \
         (32768) cannot be held; check the interpolant",
    );
}

#[test]
fn a_weight_below_minus_two_is_refused() {
    let refused = refusal(|file| file["kernel"][64][0] = json!(-32769));
    let place = Place::Weight { node: 64, weight: "g0" };
    assert!(matches!(&refused, ContentError::Range { place: named, .. } if *named == place), "{refused:?}");
}

#[test]
fn missing_and_surplus_nodes_are_counted() {
    let refused = refusal(|file| drop(file["kernel"].as_array_mut().unwrap().pop()));
    says(&refused, "`kernel` has 64 entries instead of 65; give one node for each x = 0, 1/32, ..., 2");
}

#[test]
fn a_node_with_a_weight_too_few_is_named() {
    let refused = refusal(|file| drop(file["kernel"][7].as_array_mut().unwrap().pop()));
    says(&refused, "node 7 of `kernel` has 4 entries instead of 5; give the five weights g0, r1, g4, r5, g6");
}

#[test]
fn what_is_no_whole_number_is_shown() {
    let values = [json!(1.5), json!("12"), json!(null), json!([1]), json!(true)];
    for (value, shown) in values.into_iter().zip(["1.5", "\"12\"", "null", "[1]", "true"]) {
        let refused = refusal(|file| file["step"][3] = value);
        let sentence = refused.to_string();
        let expected = format!(
            "the row factor of row 3 is {shown}, not a whole number in plain digits; a row factor is "
        );
        assert!(sentence.starts_with(&expected), "{sentence}");
    }
}

/// JSON's reader has no whole numbers beyond 64 bits.
#[test]
fn what_is_far_too_large_is_not_said_to_have_a_fraction() {
    for (text, shown) in [("1180591620717411303424", "1.1805916207174113e21"), ("-1e30", "-1e30")] {
        let value: Value = serde_json::from_str(text).unwrap();
        let refused = refusal(|file| file["height"] = value);
        let sentence = refused.to_string().replace("e+", "e");
        let expected = format!("`height` is {shown}, not a whole number of 64 bits; ");
        assert!(sentence.starts_with(&expected), "{sentence}");
    }
}

#[test]
fn every_number_must_be_whole() {
    for key in ["datapath", "width", "height", "bits", "centre2"] {
        let refused = refusal(|file| file[key] = json!(1.0));
        assert!(matches!(refused, ContentError::Kind { place, .. } if place.key() == key), "{refused:?}");
    }
    let refused = refusal(|file| file["kernel"][0][1] = json!(0.5));
    assert!(matches!(refused, ContentError::Kind { place: Place::Weight { node: 0, weight: "r1" }, .. }));
}

#[test]
fn what_should_be_a_list_or_an_object_is_named() {
    let refused = refusal(|file| file["step"] = json!(16_777_216));
    says(&refused, "`step` is 16777216, not a list; give one row factor for each row, from the top");
    let refused = refusal(|file| file["kernel"][3] = json!({"g0": 0}));
    assert!(matches!(refused, ContentError::Kind { place: Place::Node { node: 3 }, .. }));
    let refused = refusal(|file| file["about"] = json!("made on Monday"));
    says(&refused, "`about` is \"made on Monday\", not an object; put your notes between { and }");
}
