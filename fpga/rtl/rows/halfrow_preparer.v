// Readies the row that enters next, as soon as it is in its bank, its out-bank is free and the row in front has
// started: reads its place, lets a frame's tables take effect, and has the core prepare it.
`default_nettype none

module halfrow_preparer #(
    parameter ROW_BITS = 11,
    parameter ENTRY_BITS = 2
) (
    input  wire                  clk,
    input  wire                  rst,         // also while rows are dropped

    input  wire                  row_there,   // row `next_entry` is in its bank and its out-bank is free
    input  wire [ENTRY_BITS-1:0] next_entry,
    input  wire [11:0]           height,
    output wire [ENTRY_BITS+2:0] place_address,
    input  wire [7:0]            place_byte,
    input  wire                  burst,       // rows are a burst's: they have no places, but numbers
    input  wire [11:0]           burst_row,
    input  wire                  burst_other, // and tables of the bank that is not active

    output wire                  frame_start, // pulse: row 0 of `frame_number` is next
    output wire [15:0]           frame_number,
    input  wire [7:0]            generation,  // of the active tables, two clocks behind frame_start
    input  wire                  active_bank,

    output wire                  prepare,     // pulse
    output wire [ROW_BITS-1:0]   prepare_row,
    input  wire                  prepared,    // low from the clock behind `prepare` until the row may start

    output reg                   ready,       // the state is READY
    input  wire                  start,       // pulse: the row starts
    output reg  [ENTRY_BITS-1:0] entry,
    output wire                  row_0,
    output reg                   row_is_last,
    output reg  [7:0]            row_generation,
    output reg                   row_bank,    // of the tables that it is bound to
    output wire                  busy
);
    localparam IDLE = 3'd0, FETCH = 3'd1, FRAME = 3'd2, BIND = 3'd3, PREPARE = 3'd4, PREPARING = 3'd5, READY = 3'd6;

    reg [2:0] state;
    reg [1:0] count;
    reg [31:0] place; // frame, row
    wire [7:0] number_byte = count[0] ? {4'd0, burst_row[11:8]} : burst_row[7:0];
    wire [11:0] last_row = height - 12'd1;

    assign place_address = {entry, 1'b1, count};
    assign frame_number = place[15:0];
    assign prepare_row = place[16 +: ROW_BITS];
    assign row_0 = place[31:16] == 16'd0;
    assign frame_start = state == FRAME && row_0;
    assign prepare = state == PREPARE;
    assign busy = state != IDLE;

    always @(posedge clk) begin
        count <= state == FETCH || state == BIND ? count + 2'd1 : 2'd0;
        if (state == IDLE)
            entry <= next_entry;
        if (state == FETCH)
            place <= {burst ? number_byte : place_byte, place[31:8]};
        if (state == BIND) begin
            row_generation <= generation;
            row_bank <= active_bank ^ burst_other;
            row_is_last <= place[31:16] == {4'd0, last_row};
        end
    end

    always @(posedge clk)
        if (rst)
            state <= IDLE;
        else
            case (state)
                IDLE: if (row_there) state <= FETCH;
                FETCH: if (count == 2'd3) state <= FRAME;
                FRAME: state <= BIND;
                BIND: if (count == 2'd1) state <= PREPARE;
                PREPARE: state <= PREPARING;
                PREPARING: if (prepared) state <= READY;
                READY: if (start) state <= IDLE;
                default: state <= IDLE;
            endcase

    always @(posedge clk)
        ready <= !rst && ((state == PREPARING && prepared) || (ready && !start));
endmodule

`default_nettype wire
