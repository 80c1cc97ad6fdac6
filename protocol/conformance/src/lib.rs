//! The tests that every board must pass, whatever it is made of: `protocol/WIRE.md`, rule by rule, through the bytes of a board.
//!
//! ```text
//! conformance!(&MyBoards) ─► #[test] … ─► Bench ── packets ─► Subject (mock, Verilog, …)
//! ```
//!
//! To test boards, implement [`Boards`] for them and write [`conformance!`] in a test. For each build that a test asks for, if
//! it is offered, the test gets a board that was just switched on.

#![expect(clippy::panic, clippy::unwrap_used, reason = "a test that cannot go on fails")]
#![expect(clippy::missing_panics_doc, reason = "a board that answers otherwise than it must fails the test")]

mod appended;
pub mod at_speed;
pub mod bench;
mod burst_ends;
mod burst_refusals;
mod bursts;
pub mod capabilities;
mod commits;
mod configuring;
mod credit;
mod damage;
mod echo;
pub mod frames;
pub mod golden_rows;
mod grid_bursts;
mod grid_commits;
mod grid_rows;
pub mod grids;
mod loss;
mod lossy_link;
pub mod material;
mod one_bank;
mod order;
mod playing;
mod random;
mod resets;
mod sessions;
mod silence;
mod status;
mod subject;
mod table_reads;
mod table_writes;
pub mod uploads;

use proptest::test_runner::{Config, FileFailurePersistence};

pub use bench::{Bench, HELLO, ReceivedPacket, rows_of, wire};
pub use commits::is_busy_while_a_row_is_inside;
pub use subject::{Boards, Build, Subject};

/// Those of these builds that are offered.
fn offered(on: &dyn Boards, builds: impl IntoIterator<Item = Build>) -> Vec<Build> {
    builds.into_iter().filter(|build| on.offers(build)).collect()
}

/// How a property is tried: with [`Boards::cases`] divided by `share` cases. Cases that failed are kept in `file`.
fn cases(on: &dyn Boards, share: u32, file: &'static str) -> Config {
    let failure_persistence = Some(Box::new(FileFailurePersistence::Direct(file)) as Box<_>);
    Config { cases: on.cases() / share, failure_persistence, ..Config::default() }
}

/// Names every test once, for [`conformance!`] to call. A test that is missing here is dead code.
macro_rules! suite {
    ($d:tt $($module:ident: $($test:ident),+;)+) => {
        #[doc(hidden)]
        pub mod suite {
            $(pub mod $module {
                $(pub fn $test(on: &dyn crate::Boards) {
                    crate::$module::$test(on);
                })+
            })+
        }

        /// Makes a `#[test]` of every test of the suite, in one module per subject, against the boards of this expression,
        /// a `&dyn Boards`.
        #[macro_export]
        macro_rules! conformance {
            ($d boards:expr) => {
                $(mod $module {
                    $(#[test]
                    fn $test() {
                        $d crate::suite::$module::$test($d boards);
                    })+
                })+
            };
        }
    };
}

suite! { $
    appended:
        requests_may_carry_fields_of_a_later_version,
        requests_of_bursts_may_carry_fields_of_a_later_version;
    burst_ends:
        a_reset_of_any_level_ends_a_burst_at_once,
        a_burst_can_follow_one_that_was_reset,
        a_new_session_ends_a_burst_and_knows_none,
        a_repeated_hello_ends_nothing,
        ten_seconds_of_silence_end_a_burst_and_its_session,
        silence_behind_a_burst_closes_nothing,
        the_trap_keeps_nothing_while_all_rows_are_expected,
        the_trap_keeps_the_first_row_that_is_not_expected,
        a_row_that_nobody_uploaded_is_expected_to_have_0,
        expected_signatures_stay_whatever_happens,
        only_a_trapped_burst_sets_the_trap_and_only_the_next_one_empties_it,
        a_reset_and_a_new_session_empty_the_trap;
    burst_refusals:
        a_board_that_makes_none_refuses_the_kinds,
        payloads_that_are_too_short_or_without_meaning_are_refused,
        without_configuration_or_committed_tables_a_board_is_not_ready,
        fields_out_of_range_are_named_the_first_of_several,
        no_burst_starts_while_the_board_holds_rows_or_a_commit_or_makes_another,
        while_a_burst_is_under_way_a_row_counts_as_inside,
        tables_are_written_during_a_burst_that_does_not_use_them,
        rows_are_refused_during_a_burst_whatever_they_are,
        rows_of_a_burst_count_in_no_counter,
        expected_signatures_end_before_max_height;
    bursts:
        the_golden_frame_is_signed_and_counted,
        golden_frames_of_other_shapes_are_signed,
        frames_are_numbered_modulo_2_16_and_a_repeating_burst_has_one,
        every_second_frame_of_an_alternating_burst_is_the_shadows,
        neither_blanking_nor_a_gap_seed_changes_a_record,
        records_stay_until_the_host_says_that_it_has_them,
        without_a_burst_there_are_no_records,
        another_burst_drops_the_records_of_the_one_before,
        a_frame_without_a_free_record_is_held_back_and_says_so,
        a_burst_without_frames_has_ended_when_it_starts,
        a_request_that_is_repeated_starts_nothing_twice,
        a_burst_may_be_made_longer_or_ended_while_it_is_under_way;
    capabilities:
        every_board_sends_all_tags_in_their_widths,
        the_build_shows;
    commits:
        the_reply_names_the_generation,
        a_commit_takes_effect_with_row_0_of_its_frame_and_not_before,
        a_commit_waits_through_frames_of_higher_numbers,
        two_frames_back_to_back_have_their_own_tables,
        every_row_of_the_frame_is_made_with_the_new_tables,
        a_crc_that_is_not_the_tables_is_refused_with_the_table,
        the_crc_covers_the_factors_of_the_configured_height,
        a_repeated_commit_is_answered_and_changes_nothing,
        a_commit_that_is_repeated_while_a_row_is_inside_is_answered,
        without_a_configuration_the_board_is_not_ready,
        generation_0_is_out_of_range,
        nothing_is_committed_while_a_row_is_inside,
        another_commit_is_refused_while_one_is_pending_whatever_its_crcs,
        hello_and_reset_forget_a_pending_commit_and_keep_its_tables,
        a_commit_for_a_frame_does_not_serve_the_frames_in_front_of_it;
    configuring:
        values_at_their_limits_are_taken_and_the_reply_is_empty,
        a_width_that_is_odd_or_out_of_range_is_field_0,
        a_height_out_of_range_is_field_1,
        a_centre_outside_the_row_is_field_2,
        too_little_blanking_is_field_3,
        a_depth_that_the_build_does_not_have_is_field_5,
        of_several_wrong_fields_bits_is_named_else_the_first,
        a_refused_configuration_leaves_the_one_before,
        a_repeated_configuration_is_taken_and_changes_nothing,
        nothing_is_configured_while_a_row_is_in_the_core,
        nothing_is_configured_while_a_row_waits_in_an_input_bank,
        nothing_is_configured_while_a_row_waits_for_its_acknowledgement;
    credit:
        credit_reaches_past_the_first_row_that_has_not_entered_by_the_input_banks,
        a_row_at_or_beyond_the_window_is_refused,
        an_acknowledgement_in_any_packet_frees_output_banks,
        even_a_refused_packet_acknowledges,
        a_smaller_window_than_before_means_nothing,
        rows_that_were_never_sent_back_cannot_be_acknowledged,
        one_acknowledgement_may_free_many_banks,
        frames_stream_through_any_number_of_banks;
    damage:
        a_flipped_bit_anywhere_is_a_crc_error_or_broken_framing,
        a_wrong_crc_is_a_crc_error,
        broken_stuffing_is_a_framing_error,
        a_packet_that_is_too_short_is_a_framing_error,
        a_packet_that_is_too_long_is_one_framing_error,
        another_version_or_length_is_a_framing_error,
        zeros_are_no_packets,
        garbage_before_the_first_zero_is_counted,
        damage_takes_one_packet_and_not_its_neighbours,
        packets_may_come_in_pieces_of_any_size;
    echo:
        bytes_come_back_as_they_went_up_to_4080,
        any_bytes_come_back_as_they_went,
        kinds_that_no_host_sends_are_refused,
        payloads_that_are_too_short_are_refused,
        fields_without_meaning_are_refused,
        entries_and_samples_that_are_missing_make_the_payload_too_short,
        the_reply_flag_of_a_request_is_not_looked_at;
    grid_bursts:
        a_burst_goes_through_the_grid,
        an_alternating_burst_goes_through_each_banks_own_shape,
        a_forgotten_commit_leaves_its_shape_in_the_shadow;
    grid_commits:
        a_board_without_grids_looks_at_no_shape,
        a_shape_out_of_range_is_named_the_first_of_several,
        a_grid_may_fill_its_bank_and_no_more,
        the_crc_covers_the_entries_of_the_configured_frame,
        a_crc_that_is_not_the_grids_is_refused_with_its_table,
        a_repeated_commit_of_another_shape_changes_nothing,
        hello_forgets_a_pending_grid_and_the_next_commit_may_be_of_row_factors;
    grid_rows:
        every_shape_makes_the_rows_of_the_page,
        without_a_shape_or_with_v_0_rows_have_one_factor_each,
        frames_back_to_back_change_between_grids_and_row_factors,
        with_one_bank_a_grid_takes_effect_at_once;
    grids:
        a_board_without_grids_refuses_their_spans_before_anything_else,
        a_grid_and_row_factors_are_one_memory,
        an_entry_out_of_range_is_named_by_its_index_and_nothing_is_written,
        spans_of_a_grid_end_before_its_last_entry,
        before_any_write_every_entry_of_a_grid_is_1,
        a_grid_is_neither_read_nor_written_while_row_factors_are_not;
    loss:
        a_row_that_waits_in_a_bank_is_not_taken_twice,
        a_row_inside_the_core_is_not_answered,
        a_row_that_came_out_is_sent_again_with_one_repeat_more,
        repeats_are_counted_for_each_row,
        a_row_is_not_played_again,
        a_row_that_comes_again_is_not_judged_by_its_place,
        an_acknowledged_row_is_not_sent_again,
        the_acknowledgement_in_the_row_itself_comes_first,
        sending_a_row_again_frees_no_bank_and_blocks_none;
    lossy_link:
        every_row_comes_back_once_played;
    one_bank:
        the_board_says_how_many_banks_it_has,
        a_commit_takes_effect_at_once_whatever_its_frame,
        both_banks_are_the_same_memory,
        rows_use_what_is_written_behind_the_commit_under_the_same_generation,
        tables_are_written_and_committed_between_frames,
        nothing_is_written_while_any_row_is_inside,
        nothing_is_committed_while_a_row_is_inside,
        commits_follow_each_other_without_a_frame_between_them,
        a_wrong_crc_leaves_the_generation,
        before_the_first_commit_no_row_is_taken;
    order:
        a_later_row_waits_for_the_missing_one,
        every_order_of_arrival_gives_the_same_rows,
        places_come_back_as_they_went,
        rows_that_are_not_the_configurations_are_refused,
        a_refused_row_can_be_sent_right,
        a_row_must_follow_the_one_that_was_played,
        a_row_must_follow_the_one_that_waits,
        nothing_but_row_0_follows_the_last_row,
        a_frame_that_became_taller_goes_on_behind_the_row_that_was_its_last,
        the_first_row_of_all_is_row_0,
        a_row_whose_predecessor_is_missing_is_taken_as_it_is,
        a_row_that_its_late_predecessor_does_not_fit_is_played_under_the_place_that_it_names,
        row_0_may_follow_any_row,
        generation_and_further_flags_of_a_row_are_not_looked_at,
        of_several_wrong_things_about_a_row_the_first_of_the_page_is_named,
        frame_numbers_are_as_the_host_likes,
        without_configuration_or_tables_no_row_is_taken,
        a_configuration_that_outlives_the_session_serves_the_next_one,
        rows_behind_the_frame_that_a_commit_waits_for_may_come_before_it,
        a_wider_configuration_takes_wider_rows;
    playing:
        the_golden_rows_come_out_of_the_wire,
        the_crc_of_what_entered_is_that_of_the_samples_that_were_sent,
        every_row_has_its_own_factor,
        outputs_are_clamped_to_the_depth_and_inputs_go_in_as_they_are,
        a_row_leaves_when_half_of_the_next_has_entered_and_a_frame_when_its_last_row_was_played,
        latencies_are_half_a_row_and_l,
        without_a_seed_nothing_pauses,
        the_tests_own_pattern_is_marsaglias,
        gaps_follow_the_seed_and_begin_anew_with_every_frame,
        gaps_and_blanking_change_no_sample,
        blanking_without_a_seed_changes_no_sample,
        samples_are_packed_two_in_three_bytes,
        a_row_that_a_new_session_cuts_off_leaves_no_trace;
    random:
        whatever_comes_the_board_keeps_its_promises_and_answers_the_next_hello,
        any_bytes_in_any_pieces_are_survived;
    resets:
        level_0_drops_all_rows_and_keeps_the_rest,
        rows_in_front_of_the_next_one_count_as_acknowledged,
        the_window_is_counted_from_the_next_row,
        rows_are_counted_on_through_a_reset,
        a_frame_must_begin_anew_behind_a_reset,
        level_1_answers_and_closes_the_session,
        a_nonce_opens_another_session_once_its_own_is_closed,
        level_2_drops_configuration_and_tables_too,
        a_repeated_reset_changes_nothing,
        a_reset_ends_a_wait_for_a_lost_row,
        a_reset_to_a_smaller_row_begins_there_anew,
        the_last_row_numbers_of_all_can_be_waited_for;
    sessions:
        hello_is_answered_with_nonce_magic_version_and_session,
        the_reply_to_hello_gives_credit_for_the_input_banks,
        a_repeated_nonce_is_answered_as_the_first_time_and_changes_nothing,
        the_same_nonce_of_another_host_opens_a_session_of_its_own,
        a_new_session_drops_rows_and_counters_and_keeps_configuration_and_tables,
        rows_are_counted_from_0_again_in_a_new_session,
        sessions_are_counted_and_1_comes_behind_255,
        a_session_that_was_closed_is_counted,
        without_a_common_version_the_refusal_names_the_boards,
        a_hello_that_is_too_short_is_refused,
        hello_may_carry_fields_of_a_later_version,
        outside_a_session_all_but_hello_is_refused,
        a_refusal_of_a_foreign_packet_carries_its_session_number,
        the_session_is_looked_at_before_kind_and_payload,
        a_foreign_acknowledgement_is_counted_and_not_answered,
        a_foreign_packet_is_not_carried_out,
        the_window_of_hello_is_not_looked_at,
        a_hello_that_names_a_session_is_answered_with_the_one_it_opens,
        whoever_takes_over_has_the_board_and_the_other_one_is_told,
        any_take_over_but_0_is_one;
    silence:
        another_host_is_told_for_how_long_the_board_is_held,
        a_refusal_of_hello_has_the_session_number_of_hello_and_the_boards_window,
        the_board_is_free_after_10_s_and_not_before,
        the_host_that_holds_the_board_may_open_another_session_at_any_time,
        every_whole_packet_of_the_holder_counts_even_one_that_is_refused,
        a_repeated_hello_of_the_holder_counts,
        damaged_and_foreign_packets_do_not_count,
        a_closed_session_holds_nothing,
        a_host_of_another_version_is_told_so_even_while_the_board_is_held;
    status:
        counters_are_sent_in_the_order_of_the_page,
        packets_counts_whole_packets_and_the_status_itself,
        repeated_and_unneeded_rows_are_counted_apart,
        next_row_in_stands_at_the_first_gap,
        next_row_out_follows_the_hosts_window,
        the_core_is_busy_from_a_frames_first_row_to_its_last,
        the_generation_is_the_active_one_not_the_pending_one,
        samples_beyond_the_depth_are_counted_in_accepted_rows_alone,
        latencies_are_the_smallest_and_the_largest_of_any_row_since_the_clear,
        clearing_answers_with_the_counters_before_it_and_leaves_what_is_no_counter,
        any_clear_but_0_clears,
        a_status_that_does_not_clear_changes_nothing_but_packets,
        counters_begin_at_0_in_a_session;
    table_reads:
        the_golden_tables_read_back_with_the_golden_crcs_through_every_port,
        a_read_answers_with_its_span_and_the_entries,
        before_any_write_nothing_is_stretched_and_all_nodes_are_0,
        the_crc_of_no_entries_is_that_of_no_bytes,
        ports_and_entries_that_are_not_there_are_refused,
        a_read_that_fits_no_packet_is_refused_and_its_crc_is_not,
        both_banks_are_read_and_a_commit_that_takes_effect_swaps_them,
        nothing_is_read_while_a_row_is_inside;
    table_writes:
        entries_are_written_from_the_first_one_on_and_nowhere_else,
        the_reply_is_empty_and_the_port_is_not_looked_at,
        a_factor_out_of_range_is_named_by_its_index_and_nothing_is_written,
        spans_end_before_max_height_and_node_65,
        a_span_of_no_entries_is_legal,
        the_active_bank_is_not_written,
        of_several_wrong_things_the_bank_is_named_then_busy_then_the_span,
        five_taps_refuse_a_node_that_needs_seven_and_name_it,
        nothing_is_written_while_a_commit_is_pending,
        the_shadow_bank_is_written_while_rows_use_the_other_one;
}
