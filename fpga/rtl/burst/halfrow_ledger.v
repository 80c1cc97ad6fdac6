// The numbers of a burst and of the frame that leaves: bytes of one small memory, counted and compared a byte a clock,
// so that an event may have to wait for its turn. Carries out BURST and RECORDS, whose payloads it reads from the
// receiver's buffer, and writes out a frame's record when the frame has left.
`default_nettype none

module halfrow_ledger #(
    parameter TABLE_BANKS = 2,
    parameter TRAP = 1
) (
    input  wire        clk,
    input  wire        rst,

    input  wire        start,          // pulse: a BURST or RECORDS lies in the receiver's buffer, up to `finished`
    input  wire        of_records,     // it is the latter
    output wire        rewind,         // pulse: its payload is read from the first byte on
    output wire        advance,        // by one byte
    input  wire [7:0]  packet_byte,    // one clock behind its address
    output reg         finished,       // pulse: with refusal and detail
    output reg  [3:0]  refusal,        // 0 for none
    output reg  [2:0]  detail,
    input  wire        ready,          // there are a configuration and tables
    input  wire        busy,           // rows are in the board, a commit waits, or a burst is under way

    output reg         starts,         // pulse: a burst, of what follows
    output wire [31:0] seed,
    output wire [15:0] first_frame,
    output wire [15:0] frame_blanking,
    output wire [1:0]  mode,
    input  wire        under_way,
    input  wire        drop,           // pulse: the burst ends at once
    input  wire        forget,         // with drop: and there was none
    output reg         named,          // there is one of this session
    input  wire        frame_begins,   // pulse
    output wire        more,           // there is another frame to be made; low for some clocks behind frame_begins

    input  wire        given,          // pulses: an output
    input  wire        paused,         // a clock without enable while a frame is inside
    input  wire        row_left,       // a row; latencies and frame_left stay for 60 clocks
    input  wire [15:0] first_latency,
    input  wire [15:0] last_latency,
    input  wire        frame_left,     // it was the frame's last
    input  wire        signed_all,     // the signature is that of all rows that have left

    input  wire [4:0]  kept,           // records that the host has not got
    output reg         frees,          // pulse: it has got so many
    output reg  [4:0]  freed,
    output reg         record_write,   // of byte record_place of a record
    output reg         head_write,     // or of the head of the reply to RECORDS
    output reg  [4:0]  record_place,
    output wire [7:0]  record_byte,    // if it is a number of this memory's
    output reg         recorded,       // pulse, behind a record's last byte
    output wire        idle
);
    `include "halfrow_wire.vh"

    localparam [3:0] IDLE = 4'd0, SWEEP = 4'd1, ROWS = 4'd2, COMPARE = 4'd3, KEEP = 4'd4, BEGUN = 4'd5, FRAMES = 4'd6,
                     SAMPLES = 4'd7, PAUSES = 4'd8, RECORD = 4'd9, LOOK = 4'd10, LOAD = 4'd11, ANEW = 4'd12,
                     FROM = 4'd13, HEAD = 4'd14, JUDGE = 4'd15;
    localparam [3:0] NONE = 4'd0;
    localparam [4:0] LAST_OF_BURST = 5'd16, LAST_OF_FRAMES = 5'd7, LAST_OF_HEAD = 5'd9;
    // Where the numbers lie, a frame's as in its record. The frames still to be made follow the name, as in BURST.
    localparam [4:0] AT_UNREAD = 5'd0, AT_SAMPLES = 5'd4, AT_ROWS = 5'd8, AT_LEAST = 5'd10, AT_MOST = 5'd12,
                     AT_PAUSES = 5'd14, AT_NAME = 5'd16, AT_FRAMES = 5'd20, AT_BEGUN = 5'd28;

    reg [3:0] state;
    reg [4:0] place; // byte of what is gone through
    reg phase; // the byte and what it meets were fetched
    reg again; // it is gone through once more, behind a look
    reg wants_records; // and no burst
    reg judged; // a BURST was looked at, and sets how many frames there are
    wire of_packet = state == LOOK || state == LOAD || state == ANEW || state == FROM;
    wire at_once = state == KEEP || state == SWEEP || state == RECORD || state == HEAD || state == JUDGE;
    wire at_rest = state == IDLE;
    wire step = phase || at_rest || at_once;
    reg [4:0] last_place;
    wire last = step && place == last_place;

    always @*
        case (state)
            SWEEP: last_place = 5'd31;
            ROWS, COMPARE, KEEP, PAUSES, JUDGE: last_place = 5'd1;
            RECORD: last_place = RECORD_BYTES - 5'd1;
            LOOK, LOAD: last_place = LAST_OF_BURST;
            ANEW: last_place = LAST_OF_FRAMES;
            HEAD: last_place = LAST_OF_HEAD;
            IDLE: last_place = 5'd0;
            default: last_place = 5'd3;
        endcase

    // Events that wait, and what they add.
    // More pauses than can be told. A frame that ends has fewer outputs and rows than can be.
    reg paused_most, all_paused;
    reg row_waits, frame_waits, begin_waits, request_waits, more_frames;
    reg [6:0] given_wait, paused_wait, amount;
    reg carry, zero; // of the bytes so far
    reg enough; // frames: no fewer than have begun
    reg no_mode, far; // what a request wants: another mode, records that there cannot be
    wire same = named && zero;
    wire looked_at = state == JUDGE && !wants_records && same && under_way && !no_mode;
    reg given_any, paused_any; // of these there are some
    // A frame that has left is recorded before the next one's outputs come.
    wire begin_due = begin_waits && !row_waits && !frame_waits;
    wire request_due = request_waits && !row_waits && !begin_waits && !frame_waits;
    wire event_due = row_waits || (!frame_waits && (begin_waits || request_waits));
    wire samples_due = !event_due && given_any;
    wire pauses_due = !event_due && paused_any && !given_any;
    wire samples_taken = at_rest && samples_due;
    wire pauses_taken = at_rest && pauses_due;
    wire begun = last && (state == FRAMES ? !again : state == BEGUN && !more_frames);

    assign idle = at_rest && !(event_due || frame_waits || given_any || paused_any);
    assign more = more_frames && !begin_waits;

    always @(posedge clk) begin
        given_wait <= (samples_taken ? 7'd0 : given_wait) + {6'd0, given};
        paused_wait <= (pauses_taken ? 7'd0 : paused_wait) + {6'd0, paused};
        given_any <= given || (given_any && !samples_taken);
        paused_any <= paused || (paused_any && !pauses_taken);
        recorded <= !rst && last && state == RECORD;
        frees <= !rst && last && state == FROM && again;
        row_waits <= row_left || (row_waits && !at_rest);
        if (recorded || starts)
            paused_most <= 1'b0;
        else if (last && state == PAUSES)
            paused_most <= paused_most || sum[9];
        frame_waits <= (row_left && frame_left) || (frame_waits && !(last && state == RECORD));
        begin_waits <= frame_begins || (begin_waits && !begun);
        if (start)
            wants_records <= of_records;
        request_waits <= start || (request_waits && !(at_rest && request_due)) || looked_at;
        if (rst || drop || starts) begin
            {given_wait, paused_wait} <= 14'd0;
            {given_any, paused_any} <= 2'd0;
            {row_waits, frame_waits, begin_waits} <= 3'd0;
        end
        if (rst)
            request_waits <= 1'b0;
        if (at_rest)
            amount <= samples_due ? given_wait : pauses_due ? paused_wait : {6'd0, begin_due};
        else if (step)
            amount <= {6'd0, last && state == KEEP}; // for ROWS
        if (rst || drop)
            amount <= 7'd0;
    end

    // Both latencies are held against both bounds.
    reg of_last, of_most, measured;
    wire [15:0] latency = of_last ? last_latency : first_latency;
    wire latency_high = state == KEEP || (place[0] && !phase); // for the next clock

    // The numbers.
    (* ram_style = "distributed" *) reg [7:0] numbers [0:31];
    reg [4:0] base;
    reg [7:0] next_operand, operand, fetched; // what meets the memory's byte, and that
    reg write, meets, negated, carry_in;
    wire head_tail = state == HEAD && place[2]; // its second number is not one of the burst's
    wire subtracts = state == COMPARE || state == LOOK || state == ANEW || (state == FROM && !again);
    wire counts = state == ROWS || state == BEGUN || state == SAMPLES || state == PAUSES;
    wire adds = counts || (state == FRAMES && (!again || enough));
    wire [4:0] read_address = head_tail ? {3'd0, place[1:0]} : base | place;
    wire first = place[1:0] == 2'd0;
    wire [4:0] write_address = state == ANEW ? AT_NAME | place : read_address;
    wire [7:0] stored = numbers[read_address];
    wire [7:0] other = (fetched & {8{meets}}) ^ {8{negated}};
    wire [9:0] sum = {1'b0, operand, 1'b1} + {1'b0, other, carry_in};
    wire [7:0] result = sum[8:1];
    wire all_zero = result == 8'd0 && (first || zero);

    // A state's numbers are found before it begins, since what they add up to comes late in the clock.
    always @(posedge clk)
        if (rst || drop)
            base <= AT_UNREAD;
        else if (last)
            case (state)
                IDLE:
                if (row_waits) base <= AT_LEAST;
                else if (begin_due || (request_due && !wants_records && judged)) base <= AT_BEGUN;
                else if (request_due) base <= wants_records ? AT_UNREAD : AT_NAME;
                else base <= samples_due ? AT_SAMPLES : pauses_due ? AT_PAUSES : AT_UNREAD;
                COMPARE: ;
                KEEP: base <= !of_most ? AT_MOST : of_last ? AT_ROWS : AT_LEAST;
                BEGUN, ANEW: base <= AT_FRAMES;
                SWEEP, FROM: base <= AT_NAME;
                default: base <= AT_UNREAD;
            endcase

    always @*
        case (state)
            SWEEP, ROWS, BEGUN, FRAMES, SAMPLES, PAUSES: write = 1'b1;
            KEEP: write = !measured || carry == of_most;
            RECORD: write = !place[4] && place[3:2] != 2'd0;
            LOAD: write = place[4:3] == 2'd0;
            ANEW: write = place[2];
            FROM: write = again;
            default: write = 1'b0;
        endcase

    always @* begin
        if (of_packet)
            next_operand = packet_byte;
        else if (state == COMPARE || state == KEEP)
            next_operand = latency_high ? latency[15:8] : latency[7:0];
        else
            next_operand = {1'b0, amount} | {8{state == FRAMES && !again}};
    end

    always @(posedge clk) begin
        operand <= next_operand;
        fetched <= stored;
        meets <= adds || subtracts;
        negated <= subtracts;
        carry_in <= first ? subtracts : carry && !at_once;
        if (rst || drop)
            operand <= 8'd0;
        if (rst || drop || phase)
            {meets, negated, carry_in} <= 3'd0;
        if (write && step)
            numbers[write_address] <= result;
    end

    always @(posedge clk)
        if (step && !at_once) begin
            carry <= sum[9];
            if (state == ANEW)
                enough <= sum[9];
            if (state != LOOK || place[4:2] == 3'd0)
                zero <= first && state == FROM ? 1'b1 : all_zero;
            if ((last && state == FRAMES) || (state == LOAD && place == LAST_OF_FRAMES))
                more_frames <= !all_zero;
            if (state == FROM && !again && first)
                {far, freed} <= {result[7:5] != 3'd0, result[4:0]};
        end

    always @(posedge clk) begin
        record_write <= state == RECORD;
        head_write <= state == HEAD;
        record_place <= place;
        all_paused <= paused_most && state == RECORD && place[4:1] == AT_PAUSES[4:1];
    end

    // What a BURST says, a clock behind the receiver's buffer, whose bytes come late. The last of them that is looked
    // at is the mode.
    reg [71:0] fields;
    reg unnamed, close, other_mode;

    always @(posedge clk)
        if (step) begin
            if (state == LOAD && place[4:3] != 2'd0)
                fields <= {operand, fields[71:8]};
            if (state == LOOK && place[4:2] == 3'd0)
                unnamed <= operand == 8'd0 && (first || unnamed);
            if (state == LOOK && place[3:0] == 4'd15)
                close <= operand == 8'd0; // below 256
            if (state == LOOK) begin
                no_mode <= operand[7:2] != 6'd0;
                other_mode <= operand[0] && (operand[1] ? TRAP == 0 : TABLE_BANKS == 1);
            end
        end

    assign {mode, frame_blanking, first_frame, seed} = fields[65:0];
    assign rewind = state == JUDGE;
    assign advance = of_packet && !phase;
    assign record_byte = fetched | {8{all_paused}};

    wire fits = zero && !far && freed <= kept;
    wire bound_done = last && state == KEEP;

    always @(posedge clk) begin
        if (rst || recorded || starts)
            measured <= 1'b0;
        else if (bound_done && of_most)
            measured <= 1'b1;
        if (at_rest)
            {of_last, of_most} <= 2'd0;
        else if (bound_done)
            {of_last, of_most} <= {of_last ^ of_most, !of_most};
    end

    always @(posedge clk) begin
        starts <= !rst && last && state == LOAD;
        finished <= 1'b0;
        phase <= !at_rest && !at_once && !phase;
        place <= last || at_rest ? 5'd0 : place + {4'd0, step};
        if (last)
            case (state)
                IDLE: begin
                    again <= 1'b0;
                    if (row_waits) state <= COMPARE;
                    else if (begin_due) state <= BEGUN;
                    else if (request_due) state <= wants_records ? FROM : judged ? ANEW : LOOK;
                    else if (samples_due) state <= SAMPLES;
                    else if (pauses_due) state <= PAUSES;
                    else if (frame_waits && signed_all) state <= RECORD;
                end
                SWEEP: state <= again ? LOAD : IDLE;
                COMPARE: state <= KEEP;
                KEEP: state <= of_last && of_most ? ROWS : COMPARE;
                BEGUN: state <= more_frames ? FRAMES : IDLE;
                LOOK: state <= JUDGE;
                ANEW: begin
                    again <= 1'b1;
                    state <= FRAMES;
                end
                FROM: state <= again ? HEAD : JUDGE;
                JUDGE: begin
                    again <= 1'b1;
                    finished <= refused || (same && !wants_records && !looked_at);
                    if (refused || (same && !wants_records)) state <= IDLE;
                    else state <= wants_records ? FROM : SWEEP;
                end
                default: begin
                    state <= IDLE;
                    finished <= state == LOAD || state == HEAD || (state == FRAMES && again);
                end
            endcase
        if (rst || drop) begin
            state <= rst || forget ? SWEEP : IDLE;
            {place, again, finished} <= 7'd0;
        end
        judged <= !rst && !drop && (looked_at || (judged && !finished));
    end

    // A request is judged twice: it is known behind the first time whether it is refused.
    wire refused = refusal != NONE;

    always @(posedge clk) begin
        if (at_rest)
            {refusal, detail} <= {NONE, 3'd0};
        else if (state == JUDGE) begin
            detail <= 3'd0;
            if (wants_records) refusal <= fits ? NONE : REFUSAL_RANGE;
            else if (no_mode) refusal <= REFUSAL_PAYLOAD;
            else if (same) refusal <= NONE;
            else if (!ready) refusal <= REFUSAL_NOT_READY;
            else if (unnamed) refusal <= REFUSAL_RANGE;
            else if (close) {refusal, detail} <= {REFUSAL_RANGE, 3'd4};
            else if (other_mode) {refusal, detail} <= {REFUSAL_RANGE, 3'd5};
            else if (busy) refusal <= REFUSAL_BUSY;
        end
    end

    always @(posedge clk)
        if (rst || (drop && forget))
            named <= 1'b0;
        else if (last && state == LOAD)
            named <= 1'b1;

    wire unused = &{1'b0, sum[0], fields[71:66]};
endmodule

`default_nettype wire
