// The counters of STATUS. Those that count lie as bytes in one small memory and are counted up a byte a clock, so an
// event may have to wait for its turn; nothing is lost while it waits.
`default_nettype none

module halfrow_status (
    input  wire        clk,
    input  wire        rst,
    input  wire        clear,         // pulse: all events so far are forgotten
    output wire        idle,          // every event has been counted

    // one-clock pulses
    input  wire        packet,
    input  wire        crc_error,
    input  wire        framing_error, // may come every third clock
    input  wire        foreign_packet,
    input  wire        refusal,
    input  wire        row_accepted,
    input  wire        row_left,      // at most three while a report is made
    input  wire        row_repeated,
    input  wire        row_unneeded,
    input  wire        sample_over,   // may come every clock
    input  wire        latency_valid,
    input  wire [15:0] first_latency, // both stay for 8 clocks
    input  wire [15:0] last_latency,

    input  wire [31:0] next_row_in,
    input  wire [31:0] acknowledged,
    input  wire        core_busy,
    input  wire [7:0]  generation,

    // The payload of the reply to STATUS. While `report` is high events wait.
    input  wire        report,
    input  wire        report_clears, // a byte is set to 0 as it is taken
    input  wire [5:0]  index,
    input  wire        take,          // pulse; indices come in order
    output reg  [7:0]  value          // two clocks behind its index, 0 without `report`
);
    `include "halfrow_wire.vh"

    localparam IDLE = 2'd0, COUNT = 2'd1, SATURATE = 2'd2, SWEEP = 2'd3;

    localparam [5:0] BOUNDS_TAKEN = {COUNTER_CORE_BUSY, 2'd0};

    reg [1:0] state;
    reg [3:0] counter;
    reg [1:0] place;  // byte of the counter
    reg [4:0] amount; // to add: events at byte 0, then the carry

    // Events that wait. Of three kinds more than one can.
    reg packet_waits, crc_waits, foreign_waits, refusal_waits, in_waits, repeated_waits, unneeded_waits;
    reg [2:0] framing_wait;
    reg [1:0] left_wait;
    reg [4:0] over_wait;

    reg [3:0] next;
    reg [4:0] next_amount;
    reg any;
    always @* begin
        any = 1'b1;
        next_amount = 5'd1;
        if (over_wait != 5'd0) begin
            next = COUNTER_SAMPLES_OVER;
            next_amount = over_wait;
        end else if (framing_wait != 3'd0) begin
            next = COUNTER_FRAMING_ERRORS;
            next_amount = {2'd0, framing_wait};
        end else if (left_wait != 2'd0) begin
            next = COUNTER_ROWS_OUT;
            next_amount = {3'd0, left_wait};
        end else if (packet_waits) next = COUNTER_PACKETS;
        else if (crc_waits) next = COUNTER_CRC_ERRORS;
        else if (foreign_waits) next = COUNTER_FOREIGN_PACKETS;
        else if (refusal_waits) next = COUNTER_REFUSALS;
        else if (in_waits) next = COUNTER_ROWS_IN;
        else if (repeated_waits) next = COUNTER_ROWS_REPEATED;
        else begin
            next = COUNTER_ROWS_UNNEEDED;
            any = unneeded_waits;
        end
    end

    wire begins = state == IDLE && any && !report;
    reg forget;
    always @(posedge clk) forget <= rst || clear;

    always @(posedge clk) begin
        packet_waits <= packet || (packet_waits && !(begins && next == COUNTER_PACKETS));
        crc_waits <= crc_error || (crc_waits && !(begins && next == COUNTER_CRC_ERRORS));
        foreign_waits <= foreign_packet || (foreign_waits && !(begins && next == COUNTER_FOREIGN_PACKETS));
        refusal_waits <= refusal || (refusal_waits && !(begins && next == COUNTER_REFUSALS));
        in_waits <= row_accepted || (in_waits && !(begins && next == COUNTER_ROWS_IN));
        repeated_waits <= row_repeated || (repeated_waits && !(begins && next == COUNTER_ROWS_REPEATED));
        unneeded_waits <= row_unneeded || (unneeded_waits && !(begins && next == COUNTER_ROWS_UNNEEDED));
        framing_wait <= (begins && next == COUNTER_FRAMING_ERRORS ? 3'd0 : framing_wait) + {2'd0, framing_error};
        left_wait <= (begins && next == COUNTER_ROWS_OUT ? 2'd0 : left_wait) + {1'b0, row_left};
        over_wait <= (begins && next == COUNTER_SAMPLES_OVER ? 5'd0 : over_wait) + {4'd0, sample_over};
        if (forget) begin
            {packet_waits, crc_waits, foreign_waits, refusal_waits, in_waits, repeated_waits, unneeded_waits} <= 7'd0;
            framing_wait <= 3'd0;
            left_wait <= 2'd0;
            over_wait <= 5'd0;
        end
    end

    // A byte is read a clock before it is counted up.
    (* ram_style = "distributed" *) reg [7:0] counters [0:63];
    reg [7:0] stored;
    wire [1:0] next_place = place + 2'd1;
    wire [5:0] read_address = report ? index : state == IDLE ? {next, 2'd0} : {counter, next_place};
    wire [5:0] write_address = report ? index : {counter, place};
    wire [7:0] read = counters[read_address];
    wire [8:0] sum = {1'b0, stored} + {4'd0, amount};
    wire write = report ? report_clears && take : state != IDLE;
    wire [7:0] written = report || state == SWEEP ? 8'd0 : state == SATURATE ? 8'hff : sum[7:0];

    always @(posedge clk) begin
        stored <= read;
        if (write) counters[write_address] <= written;
    end

    always @(posedge clk) begin
        case (state)
            IDLE:
            if (begins) begin
                state <= COUNT;
                counter <= next;
                amount <= next_amount;
                place <= 2'd0;
            end
            COUNT: begin
                place <= next_place;
                amount <= 5'd1;
                if (!sum[8]) state <= IDLE;
                else if (place == 2'd3) state <= SATURATE;
            end
            SATURATE: begin
                place <= place + 2'd1;
                if (place == 2'd3) state <= IDLE;
            end
            default: begin
                {counter, place} <= {counter, place} + 6'd1;
                if (&{counter, place}) state <= IDLE;
            end
        endcase
        if (forget) begin
            state <= SWEEP;
            {counter, place} <= 6'd0;
        end
    end

    // Both latencies of a row are held against both bounds, one after the other. A report takes the bounds some bytes
    // before they are sent, between two rows.
    reg measuring, measured;
    reg of_last, of_most;
    reg report_due;
    reg [15:0] least, most;
    reg [31:0] reported;
    wire [15:0] latency = of_last ? last_latency : first_latency;
    wire below = latency < (of_most ? most : least);
    wire latch = report_due && !measuring;

    always @(posedge clk) begin
        report_due <= (report && take && index == BOUNDS_TAKEN) || (report_due && !latch);
        measuring <= latency_valid || (measuring && !(of_last && of_most));
        {of_last, of_most} <= measuring ? {of_last ^ of_most, !of_most} : 2'd0;
        if (measuring && of_most) measured <= 1'b1;
        if (measuring && !of_most && (below || !measured)) least <= latency;
        if (measuring && of_most && !below) most <= latency;
        if (latch) reported <= {most, least};
        if (forget || (latch && report_clears)) begin
            measured <= 1'b0;
            least <= 16'd0;
            most <= 16'd0;
        end
        if (forget) {measuring, report_due} <= 2'd0;
    end

    assign idle = state == IDLE && !any && !measuring;

    // Counters up to byte 39; then four words from elsewhere and the two bounds. All but one of these are 0.
    reg [7:0] next_row_byte, acknowledged_byte, now_byte, latency_byte, counter_byte;
    wire high = index[5] && index[4:3] != 2'd0;

    always @(posedge clk) begin
        if (high || !report) counter_byte <= 8'd0;
        else counter_byte <= read;
        if (!high || index[4] || index[2] || !report) next_row_byte <= 8'd0;
        else next_row_byte <= next_row_in[{index[1:0], 3'd0} +: 8];
        if (!high || index[4] || !index[2] || !report) acknowledged_byte <= 8'd0;
        else acknowledged_byte <= acknowledged[{index[1:0], 3'd0} +: 8];
        if (!high || !index[4] || index[3] || index[1:0] != 2'd0 || !report) now_byte <= 8'd0;
        else now_byte <= index[2] ? generation : {7'd0, core_busy};
        if (!high || !index[4] || !index[3] || index[1] || !report) latency_byte <= 8'd0;
        else latency_byte <= reported[{index[2], index[0], 3'd0} +: 8];
        value <= counter_byte | next_row_byte | acknowledged_byte | now_byte | latency_byte;
    end
endmodule

`default_nettype wire
