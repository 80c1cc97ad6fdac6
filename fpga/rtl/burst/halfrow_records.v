// The records of frames that a host has not got, in a ring of slots, and the payload of the reply to RECORDS: a head
// and the records, byte by byte. A frame begins only while a slot is free for it.
`default_nettype none

module halfrow_records #(
    parameter SLOT_BITS = 4 // 2 ** SLOT_BITS records
) (
    input  wire               clk,
    input  wire               rst,          // also when a burst starts: none is left

    input  wire               frame_begins, // pulse, while free
    output wire               free,
    input  wire               drop,         // pulse: frames that have begun leave no record
    input  wire               record_write, // of record_byte, number record_place of the record that is made
    input  wire               head_write,   // or of the reply's head
    input  wire [4:0]         record_place,
    input  wire [7:0]         record_byte,
    input  wire               recorded,     // pulse: with the record's last byte
    input  wire               frees,        // pulse: the oldest ones go
    input  wire [SLOT_BITS:0] freed,        // so many
    output reg  [SLOT_BITS:0] kept,

    input  wire               reply_begins, // pulse: the payload's first byte is wanted
    input  wire               advance,      // the next one is
    output reg  [7:0]         value         // two clocks later
);
    `include "halfrow_wire.vh"

    localparam [4:0] HEAD_BYTES = 5'd10;

    // Those of frames that are inside, too, which have a slot but nothing in it yet.
    reg [SLOT_BITS:0] taken;
    reg [SLOT_BITS-1:0] oldest, made;
    wire [SLOT_BITS:0] going = freed & {SLOT_BITS + 1{frees}};

    assign free = !taken[SLOT_BITS];

    always @(posedge clk)
        if (rst) begin
            taken <= {SLOT_BITS + 1{1'b0}};
            kept <= {SLOT_BITS + 1{1'b0}};
            oldest <= {SLOT_BITS{1'b0}};
            made <= {SLOT_BITS{1'b0}};
        end else begin
            taken <= (drop ? kept : taken) - going + {{SLOT_BITS{1'b0}}, frame_begins};
            kept <= kept - going + {{SLOT_BITS{1'b0}}, recorded};
            oldest <= oldest + going[SLOT_BITS-1:0];
            made <= made + {{SLOT_BITS - 1{1'b0}}, recorded};
        end

    // A slot has 32 bytes; the head lies behind them all.
    (* ram_style = "block" *) reg [7:0] bytes [0:(64<<SLOT_BITS)-1];
    wire [SLOT_BITS+5:0] written_at = {head_write, made & {SLOT_BITS{!head_write}}, record_place};
    reg in_head;
    reg [SLOT_BITS-1:0] slot;
    reg [4:0] place;
    wire last = place == (in_head ? HEAD_BYTES : RECORD_BYTES) - 5'd1;

    always @(posedge clk) begin
        if (record_write || head_write)
            bytes[written_at] <= record_byte;
        value <= bytes[{in_head, slot & {SLOT_BITS{!in_head}}, place}];
    end

    always @(posedge clk)
        if (reply_begins) begin
            in_head <= 1'b1;
            slot <= oldest;
            place <= 5'd0;
        end else if (advance) begin
            in_head <= in_head && !last;
            slot <= slot + {{SLOT_BITS - 1{1'b0}}, last && !in_head};
            place <= last ? 5'd0 : place + 5'd1;
        end
endmodule

`default_nettype wire
