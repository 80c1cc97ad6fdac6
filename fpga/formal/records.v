// halfrow_records under frames that begin, leave their record or are dropped, and a host that has some of the records, at any
// time: no record is written over one that the host has not got, whatever the order, nor the reply's head over a record. The
// monitor counts by itself.
`default_nettype none

module records #(
    parameter SLOT_BITS = 2
) (
    input wire               clk,
    input wire               wants_reset,
    input wire               wants_frame,
    input wire               wants_write,
    input wire               wants_head,
    input wire               wants_record,
    input wire               wants_drop,
    input wire               wants_records,
    input wire [SLOT_BITS:0] wanted,
    input wire [4:0]         place,
    input wire [7:0]         value
);
    localparam RECORDS = 1 << SLOT_BITS;

    reg running = 1'b0;
    always @(posedge clk) running <= 1'b1;
    wire rst = !running || wants_reset;

    reg [SLOT_BITS:0] unread;                // records that were made and the host has not got
    reg [1:0] inside;                        // frames that have begun and left none

    wire free;
    wire [SLOT_BITS:0] kept;
    wire [SLOT_BITS-1:0] made, oldest;
    wire [SLOT_BITS+5:0] written_at;
    wire [7:0] reply;
    wire frame_begins = wants_frame && free && inside != 2'd2 && !wants_drop;
    wire recorded = wants_record && inside != 2'd0 && !wants_drop;
    wire frees = wants_records && wanted <= unread;
    wire record_write = wants_write && inside != 2'd0;
    wire head_write = wants_head && !wants_write;

    halfrow_records dut (
        .clk(clk), .rst(rst), .frame_begins(frame_begins), .free(free), .drop(wants_drop),
        .record_write(record_write), .head_write(head_write), .record_place(place),
        .record_byte(value), .recorded(recorded), .frees(frees), .freed(wanted), .kept(kept), .reply_begins(1'b0),
        .advance(1'b0), .value(reply), .made(made), .oldest(oldest), .written_at(written_at));

    always @(posedge clk)
        if (rst) begin
            unread <= 0;
            inside <= 2'd0;
        end else begin
            unread <= unread + recorded - (frees ? wanted : 0);
            inside <= wants_drop ? 2'd0 : inside + frame_begins - recorded;
        end

    always @(posedge clk)
        if (running && !rst) begin
            told: assert (kept == unread);
            room_for_all: assert (unread + inside <= RECORDS);
            in_its_turn: assert (made == ((oldest + unread) & (RECORDS - 1)));
            if (record_write) begin
                none_overwritten: assert (unread < RECORDS);
                in_its_slot: assert (written_at == {1'b0, made, place});
            end
            if (head_write)
                behind_them_all: assert (written_at == {1'b1, {SLOT_BITS{1'b0}}, place});
            free_again: assert (free == (unread + inside < RECORDS));
        end
endmodule

`default_nettype wire
