// Sends rows that have left the core: each one once as soon as it can, before any that is asked for again.
`default_nettype none

module halfrow_row_sender #(
    parameter OUT_BITS = 1,
    parameter ENTRY_BITS = 2,
    parameter COLUMN_BITS = 11
) (
    input  wire                   clk,
    input  wire                   rst,
    input  wire                   drop,         // pulse: rows are dropped; a packet under way is still sent
    input  wire                   new_session,  // with drop: packets are counted from 0
    input  wire [7:0]             session,

    input  wire [11:0]            width,
    output reg  [11:0]            sample_bytes, // of a row, packed
    input  wire                   unsent,       // row `unsent_entry` has left the core and was never sent
    input  wire [ENTRY_BITS-1:0]  unsent_entry,
    output wire                   sent,         // pulse: it has been
    input  wire                   again,        // pulse, while again_waiting is low
    input  wire [ENTRY_BITS-1:0]  again_entry,
    output reg                    again_waiting,
    input  wire [OUT_BITS-1:0]    wanted_bank,
    output wire                   wanted_held,  // that out-bank is still to be sent
    output wire                   place_held,   // the place of a row that was dropped is still to be sent

    output wire [ENTRY_BITS+2:0]  place_address,
    input  wire [7:0]             place_byte,
    output wire [OUT_BITS-1:0]    bank,         // whose row's head and samples are sent
    output wire [3:0]             head_index,   // byte 8 to 19, or 20 to 23 behind the samples, modulo 16
    input  wire [7:0]             head_byte,
    output reg                    counted,      // pulse: counted_byte becomes byte 18 or 19
    output reg                    counted_high, // byte 19
    output reg  [7:0]             counted_byte,
    output wire                   sample_read,
    output reg  [COLUMN_BITS-1:0] column,       // to be read next
    input  wire [11:0]            read_sample,  // by the last sample_read

    output wire                   row_valid,
    output wire [7:0]             row_kind,
    output reg  [15:0]            row_sequence, // counts ROW_OUT packets
    output reg  [7:0]             row_session,
    output reg  [15:0]            row_length,
    output wire                   row_flag,
    input  wire                   row_taken,
    output reg                    row_byte_valid,
    output reg  [7:0]             row_byte,
    input  wire                   row_byte_ready,
    output wire                   idle
);
    `include "halfrow_wire.vh"

    localparam IDLE = 2'd0, OFFER = 2'd1, HEAD = 2'd2, SAMPLES = 2'd3;
    localparam [4:0] HEAD_BYTES = 5'd20, ALL_BYTES = 5'd24; // without and with those behind the samples

    reg [1:0] state;
    reg [ENTRY_BITS-1:0] entry, waiting_entry;
    reg first_time;
    reg dropped; // while it was sent
    reg [COLUMN_BITS-1:0] end_column; // `column` when the row's last byte goes
    reg [15:0] packets;

    assign bank = entry[OUT_BITS-1:0];
    assign row_kind = KIND_ROW_OUT;
    assign row_flag = 1'b0;
    assign row_valid = state == OFFER;
    assign idle = state == IDLE && !unsent && !again_waiting && !row_byte_valid;
    assign wanted_held = (state != IDLE && bank == wanted_bank)
                         || (again_waiting && waiting_entry[OUT_BITS-1:0] == wanted_bank);
    assign place_held = dropped && state == HEAD;

    reg [4:0] head;    // byte of the head, which goes on behind the samples
    reg [1:0] phase;   // byte of three
    reg [3:0] earlier; // bits of the sample before
    wire move = (state == HEAD || state == SAMPLES) && (!row_byte_valid || row_byte_ready);
    wire last_of_head = head == HEAD_BYTES - 5'd1;
    wire head_ends = move && state == HEAD && last_of_head;
    wire samples_end = move && state == SAMPLES && phase == 2'd2 && column == end_column;
    wire row_ends = move && state == HEAD && head == ALL_BYTES - 5'd1;

    assign place_address = {entry, head[2:0]};
    assign sent = row_ends && first_time && !dropped;

    always @(posedge clk) begin
        if (again) begin
            again_waiting <= 1'b1;
            waiting_entry <= again_entry;
        end else if (state == IDLE && !unsent)
            again_waiting <= 1'b0;
        if (rst || drop)
            again_waiting <= 1'b0;
    end

    always @(posedge clk)
        if (rst)
            state <= IDLE;
        else
            case (state)
                IDLE: if ((unsent || again_waiting) && !drop) state <= OFFER;
                OFFER: state <= row_taken ? HEAD : drop ? IDLE : OFFER;
                HEAD: state <= head_ends ? SAMPLES : row_ends ? IDLE : HEAD;
                default: if (samples_end) state <= HEAD;
            endcase

    always @(posedge clk) begin
        if (state == IDLE) begin
            entry <= unsent ? unsent_entry : waiting_entry;
            first_time <= unsent;
            end_column <= width[COLUMN_BITS-1:0] + 1'b1;
            row_length <= {4'd0, sample_bytes} + {11'd0, ALL_BYTES};
            row_sequence <= packets;
            row_session <= session;
        end
        sample_bytes <= width + {1'b0, width[11:1]};
        dropped <= state != IDLE && (dropped || drop);
    end

    always @(posedge clk)
        if (rst || (drop && new_session))
            packets <= 16'd0;
        else if (row_taken)
            packets <= packets + 16'd1;

    // How often the row was sent before, byte by byte; it stays at the greatest number.
    reg [(1<<OUT_BITS)-1:0] greatest;
    reg low_greatest, carry;
    wire high = head[0];
    wire [9:0] next_count = {1'b0, head_byte, 1'b1} + {9'd0, high ? carry : !greatest[bank]};
    wire unused = &{1'b0, next_count[0]};

    wire counts = head[4] && !head[2] && head[1];
    wire [7:0] count_byte = first_time ? 8'd0 : next_count[8:1];

    assign head_index = head[3:0];

    always @(posedge clk) begin
        counted <= move && state == HEAD && counts;
        counted_high <= high;
        counted_byte <= count_byte;
        if (move)
            carry <= next_count[9];
        if (counted && counted_high)
            greatest[bank] <= low_greatest && counted_byte == 8'hff;
        else if (counted)
            low_greatest <= counted_byte == 8'hff;
    end

    reg [11:0] sample;
    reg [7:0] sample_byte;

    always @*
        case (phase)
            2'd0: sample_byte = sample[7:0];
            2'd1: sample_byte = {sample[3:0], earlier};
            default: sample_byte = sample[11:4];
        endcase

    always @(posedge clk) begin
        if (move)
            row_byte <= state == SAMPLES ? sample_byte
                        : head[4:3] == 2'd0 ? place_byte : counts ? count_byte : head_byte;
        row_byte_valid <= !rst && (move || (row_byte_valid && !row_byte_ready));
    end

    // A sample gets a register of its own, since a memory's output comes late in the clock. The first is read all
    // through the head, and each further one when the one two before it has lent its last whole byte.
    wire next_sample = head_ends || (move && state == SAMPLES && phase != 2'd1);
    assign sample_read = (state == HEAD && !last_of_head) || next_sample;

    always @(posedge clk)
        if (next_sample)
            sample <= read_sample;

    always @(posedge clk) begin
        if (state == OFFER) begin
            head <= 5'd0;
            phase <= 2'd0;
            column <= {COLUMN_BITS{1'b0}};
        end else begin
            if (next_sample || (move && state == HEAD && head == HEAD_BYTES - 5'd2))
                column <= column + 1'b1;
            if ((move && state == HEAD && !last_of_head) || samples_end)
                head <= head + 5'd1;
            if (move && state == SAMPLES) begin
                phase <= phase == 2'd2 ? 2'd0 : phase + 2'd1;
                earlier <= sample[11:8];
            end
        end
    end
endmodule

`default_nettype wire
