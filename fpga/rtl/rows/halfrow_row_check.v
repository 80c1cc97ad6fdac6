// Looks at the place of a ROW_IN packet as its bytes pass, and says how it stands to the rows before it, to the
// settings and to the tables. What it says is complete three clocks behind the last byte.
`default_nettype none

module halfrow_row_check #(
    parameter ENTRY_BITS = 2
) (
    input  wire                  clk,
    input  wire                  begins,        // clears the findings
    input  wire                  byte_valid,
    input  wire [3:0]            byte_index,    // 0 to 11
    input  wire [7:0]            place_byte,
    input  wire [2:0]            before_index,  // the number that byte_index has a clock later
    input  wire [7:0]            before_byte,   // that byte of the row in front
    input  wire [11:0]           packet_length, // bytes of payload

    input  wire [31:0]           acknowledged,
    input  wire [11:0]           width,
    input  wire [11:0]           height,
    input  wire [15:0]           commit_frame,

    output reg  [ENTRY_BITS-1:0] entry,         // low bits of the row sequence number, from the first byte on
    output reg                   passed,        // it lies before `acknowledged`
    output reg                   far,           // at least 2 ** ENTRY_BITS behind it
    output reg  [ENTRY_BITS-1:0] distance,      // behind it, unless far or passed
    output reg                   last_number,   // it is the last of all
    output reg                   row_0,
    output reg                   follows,       // the row in front is its predecessor in the frame
    output reg                   commit_fits,   // it is of the frame that a commit would wait for
    output wire                  fits,          // width, row and flag are those of the settings
    output reg                   short          // the payload has not all samples of its width
);
    wire [7:0] acknowledged_byte = acknowledged[{byte_index[1:0], 3'd0} +: 8];
    wire [9:0] difference = {1'b0, place_byte, 1'b0} - {1'b0, acknowledged_byte, passed};

    always @(posedge clk)
        if (begins) begin
            passed <= 1'b0;
            far <= 1'b0;
            last_number <= 1'b1;
        end else if (byte_valid && byte_index < 4'd4) begin
            passed <= difference[9];
            last_number <= last_number && place_byte == 8'hff;
            if (byte_index == 4'd0) begin
                entry <= place_byte[ENTRY_BITS-1:0];
                distance <= difference[ENTRY_BITS:1];
                far <= difference[8:ENTRY_BITS+1] != {8-ENTRY_BITS{1'b0}};
            end else
                far <= far || difference[8:1] != 8'd0;
        end

    wire in_frame = byte_index[3:1] == 3'd2;
    wire in_row = byte_index[3:1] == 3'd3;
    wire high = byte_index[0];
    wire [7:0] commit_byte = high ? commit_frame[15:8] : commit_frame[7:0];

    // Rows below this one: height - 1 - row.
    reg row_outside, row_is_last;
    wire [7:0] height_byte = high ? {4'd0, height[11:8]} : height[7:0];
    wire [9:0] rows_below = {1'b0, height_byte, 1'b0} - {1'b0, place_byte, !high || row_outside};

    // The predecessor's bytes with 1 added to its row.
    reg carry;
    reg [7:0] expected;
    wire counts = before_index[2:1] == 2'd3 && (!before_index[0] || carry);
    wire unused = &{1'b0, difference[0], rows_below[0]};

    always @(posedge clk)
        {carry, expected} <= {1'b0, before_byte} + {8'd0, counts};

    always @(posedge clk)
        if (begins) begin
            commit_fits <= 1'b1;
            follows <= 1'b1;
            row_0 <= 1'b1;
            row_is_last <= 1'b1;
        end else if (byte_valid) begin
            if (in_frame)
                commit_fits <= commit_fits && place_byte == commit_byte;
            if (in_frame || in_row)
                follows <= follows && place_byte == expected;
            if (in_row) begin
                row_0 <= row_0 && place_byte == 8'd0;
                row_outside <= rows_below[9];
                row_is_last <= row_is_last && rows_below[8:1] == 8'd0;
            end
        end

    reg [15:0] row_width;
    reg width_fits, flagged_last;
    reg [12:0] bytes_needed, bytes_there;

    always @(posedge clk) begin
        if (byte_valid && byte_index == 4'd8)
            row_width[7:0] <= place_byte;
        if (byte_valid && byte_index == 4'd9)
            row_width[15:8] <= place_byte;
        if (byte_valid && byte_index == 4'd10)
            flagged_last <= place_byte[0];
        width_fits <= row_width == {4'd0, width};
        bytes_needed <= {1'b0, row_width[11:1], 1'b0} + {2'd0, row_width[11:1]};
        bytes_there <= {1'b0, packet_length} - 13'd12;
        short <= bytes_there[12] || row_width[15:12] != 4'd0 || bytes_needed > bytes_there;
    end

    assign fits = width_fits && !row_outside && flagged_last == row_is_last;
endmodule

`default_nettype wire
