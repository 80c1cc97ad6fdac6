// The trap of fpga/AT-SPEED.md: what signatures a host expects of a frame's rows, and the first row of a burst that has
// another one, kept with its samples until the trap is emptied. Carries out EXPECT and TRAP.
`default_nettype none

module halfrow_trap #(
    parameter MAX_HEIGHT = 2048,
    parameter COLUMN_BITS = 11
) (
    input  wire        clk,
    input  wire        rst,
    output reg         ready,         // no row is expected to have a signature from before rst

    input  wire        expect_start,  // pulse: an EXPECT lies in the receiver's buffer, up to `finished`
    input  wire [15:0] first,         // row that it names
    input  wire [15:0] count,         // of signatures
    input  wire [11:0] packet_length, // bytes
    output wire        advance,       // by one byte; packet_byte is the first signature's two clocks behind the start
    input  wire [7:0]  packet_byte,   // one clock behind its address
    input  wire        trap_start,    // pulse: a TRAP does
    output reg         finished,      // pulse: with what follows, which is 0 otherwise
    output reg  [3:0]  refusal,
    output wire [15:0] detail,
    output reg  [11:0] reply_length,  // bytes of the payload of the reply to TRAP
    input  wire        reply_begins,  // pulse: its first byte is wanted
    input  wire        reply_advance, // the next one is
    output wire [7:0]  value,         // two clocks later, or 0 where it is a sample's byte,
    output wire [7:0]  sample_value,  // which is 0 elsewhere: it comes late in the clock, out of a memory

    input  wire        under_way,     // a burst is
    input  wire        compares,      // and its rows are compared
    input  wire        empty,         // pulse: nothing is kept, and the next row is row 0 of frame 0
    input  wire [11:0] width,
    input  wire [11:0] height,
    input  wire [11:0] sample_bytes,  // of a row, packed
    input  wire        given,         // an output
    input  wire        last,          // it is its row's last
    input  wire [11:0] sample,
    input  wire [31:0] row_signature, // of the row, from a clock behind its last output on for 60 clocks
    input  wire        frame_left     // it was the frame's last, likewise
);
    `include "halfrow_wire.vh"
    `include "halfrow_board.vh"

    localparam ADDRESS_BITS = bits_for(MAX_HEIGHT);
    localparam [3:0] NONE = 4'd0;
    localparam [11:0] HEAD_BYTES = 12'd13;
    // What stands at places of the reply: `kept`, then the head, then over and over the bytes of two samples.
    localparam [3:0] AT_KEPT = 4'd15, AT_LOW = 4'd12, AT_MIDDLE = 4'd13, AT_HIGH = 4'd14;
    // An output is written so many clocks late: the row in front has been compared before it is overwritten.
    localparam LATE = 8;

    // What is expected. The walk over rows that brings zeros behind rst brings the signatures of an EXPECT, too.
    (* ram_style = "block" *) reg [7:0] expected [0:(4<<ADDRESS_BITS)-1];
    reg judging, walking, short, far;
    reg [12:0] end_row; // of EXPECTs that go no further; counts are below 1024
    reg [ADDRESS_BITS:0] walk_row;
    reg [1:0] walk_byte;
    wire arrived = walk_row == end_row[ADDRESS_BITS:0];
    wire too_far = far || {19'd0, end_row} > MAX_HEIGHT;
    wire [3:0] verdict = short ? REFUSAL_PAYLOAD : under_way ? REFUSAL_BUSY : too_far ? REFUSAL_RANGE : NONE;

    assign advance = judging || walking;
    assign detail = first & {16{refusal == REFUSAL_RANGE}};

    always @(posedge clk) begin
        judging <= expect_start && !rst;
        short <= count[15:10] != 6'd0 || count[9:0] >= packet_length[11:2];
        far <= first[15:12] != 4'd0;
        refusal <= judging ? verdict : NONE;
        finished <= !rst && (trap_start || (judging && verdict != NONE) || (walking && arrived && ready));
        walking <= rst || (judging && verdict == NONE) || (walking && !arrived);
        ready <= !rst && (ready || (walking && arrived));
        if (rst)
            end_row <= MAX_HEIGHT[12:0];
        else if (expect_start)
            end_row <= {1'b0, first[11:0]} + {3'd0, count[9:0]};
        if (rst)
            {walk_row, walk_byte} <= {ADDRESS_BITS + 3{1'b0}};
        else
            {walk_row, walk_byte} <= (judging ? {first[ADDRESS_BITS:0], 2'd0} : {walk_row, walk_byte})
                + {{ADDRESS_BITS+2{1'b0}}, !judging};
    end

    // A row that has left is compared byte by byte.
    reg kept;
    reg [31:0] frame, signature;
    reg [11:0] row;
    reg in_frame; // the row is one
    reg [1:0] part;
    reg [3:0] place;
    reg fetched, meets, differs;
    reg [7:0] expected_byte, signature_byte;
    reg [3:0] unequal; // pairs of their bits; the memory brings them late in the clock
    reg [LATE-1:0] late_given, late_last;
    reg [12*LATE-1:0] late_sample;
    wire write = late_given[LATE-1] && !kept;
    wire settled = late_last[LATE-1] && !kept;
    wire compared = late_last[1] || part != 2'd0;

    always @(posedge clk) begin
        if (walking && !arrived)
            expected[{walk_row[ADDRESS_BITS-1:0], walk_byte}] <= packet_byte & {8{ready}};
        expected_byte <= expected[{row[ADDRESS_BITS-1:0], part}];
    end

    always @(posedge clk) begin
        late_given <= {late_given[LATE-2:0], given && compares};
        late_last <= {late_last[LATE-2:0], given && last && compares};
        late_sample <= {late_sample[12*LATE-13:0], sample};
        part <= part + {1'b0, compared};
        fetched <= compared;
        meets <= fetched;
        unequal <= {signature_byte[7:6] != expected_byte[7:6], signature_byte[5:4] != expected_byte[5:4],
                    signature_byte[3:2] != expected_byte[3:2], signature_byte[1:0] != expected_byte[1:0]};
        if (late_last[0] && !kept)
            signature <= row_signature;
        signature_byte <= signature[{kept ? place[1:0] : part, 3'd0} +: 8];
        differs <= (meets && unequal != 4'd0) || (differs && !late_last[0]);
        in_frame <= row != height;
        if (rst || empty)
            {late_given, late_last, part} <= {2 * LATE + 2{1'b0}};
    end

    always @(posedge clk) begin
        if (rst || empty) begin
            kept <= 1'b0;
            row <= 12'd0;
            frame <= 32'd0;
        end else if (settled && differs && in_frame)
            kept <= 1'b1;
        else if (settled) begin
            row <= frame_left ? 12'd0 : row + {11'd0, in_frame};
            frame <= frame + {31'd0, frame_left};
        end
    end

    // Its samples.
    (* ram_style = "block" *) reg [11:0] samples [0:(1<<COLUMN_BITS)-1];
    reg [COLUMN_BITS-1:0] column; // that is written next, or read
    reg [11:0] kept_width, kept_bytes, read_sample;
    reg [3:0] earlier; // bits of the sample before
    reg told, begins; // a clock late, for which `told` has time
    wire next_column = kept ? reply_advance && (place == AT_LOW || place == AT_HIGH) : write;

    always @(posedge clk) begin
        if (write)
            samples[column] <= late_sample[12*LATE-1:12*LATE-12];
        read_sample <= samples[column];
    end

    always @(posedge clk) begin
        if (rst || empty || (begins && kept) || settled)
            column <= {COLUMN_BITS{1'b0}};
        else
            column <= column + {{COLUMN_BITS-1{1'b0}}, next_column};
        if (!kept)
            {kept_width, kept_bytes} <= {width, sample_bytes};
    end

    // What is told of it.
    always @(posedge clk) begin
        if (trap_start) begin
            told <= kept;
            reply_length <= kept ? kept_bytes + HEAD_BYTES : 12'd1;
        end
        begins <= reply_begins;
        if (begins)
            place <= AT_KEPT;
        else if (reply_advance)
            place <= place == AT_HIGH ? AT_LOW : place + 4'd1;
        if (reply_advance && place == AT_LOW)
            earlier <= read_sample[11:8];
    end

    // What a byte is chosen by stands ready when the memory brings the sample.
    reg [7:0] of_head;
    reg of_signature, of_low, of_middle, of_high;

    always @(posedge clk) begin
        case (place[3:2])
            2'd0: of_head <= frame[{place[1:0], 3'd0} +: 8];
            2'd1:
            case (place[1:0])
                2'd0: of_head <= row[7:0];
                2'd1: of_head <= {4'd0, row[11:8]};
                2'd2: of_head <= kept_width[7:0];
                default: of_head <= {4'd0, kept_width[11:8]};
            endcase
            default: of_head <= {7'd0, told && place == AT_KEPT};
        endcase
        of_signature <= place[3:2] == 2'd2;
        of_low <= place == AT_LOW;
        of_middle <= place == AT_MIDDLE;
        of_high <= place == AT_HIGH;
        if (begins)
            {of_head, of_signature, of_low, of_middle, of_high} <= {7'd0, told, 4'd0};
    end

    assign value = of_signature ? signature_byte : of_head;
    assign sample_value = (read_sample[7:0] & {8{of_low}}) | ({read_sample[3:0], earlier} & {8{of_middle}})
        | (read_sample[11:4] & {8{of_high}});

    wire unused = &{1'b0, packet_length[1:0]};
endmodule

`default_nettype wire
