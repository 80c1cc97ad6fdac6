// Signs rows as they pass, AT-SPEED.md's Signature: a burst's at the image processor's pins, others where they enter,
// at the core's; and of a burst the frame, a bit a clock behind each of its rows.
`default_nettype none

module halfrow_signer (
    input  wire        clk,
    input  wire        rst,        // also while there is no burst: of the frame

    input  wire        anew,       // pulse: the next sample is a row's first, whatever came in front of it
    input  wire        valid,      // a sample stands at the pins
    input  wire        last,       // and is its row's last
    input  wire [11:0] sample,
    input  wire        next_frame, // pulse, while signed: the signature was taken, and the next row begins a frame
    output wire        signed_all, // all rows that have left are in the signature; each takes 33 clocks
    output wire [31:0] row_signature, // a clock behind a row's last sample, up to the next row's
    output wire [31:0] signature   // of the frame
);
    localparam [31:0] POLYNOMIAL = 32'hEDB88320;
    localparam [31:0] PRESET = 32'hFFFFFFFF;

    // Two bytes' steps of the CRC-32.
    function [31:0] step(input [31:0] crc, input [15:0] word);
        integer i;
        begin
            step = crc ^ {16'd0, word};
            for (i = 0; i < 16; i = i + 1) step = {1'b0, step[31:1]} ^ (step[0] ? POLYNOMIAL : 32'd0);
        end
    endfunction

    reg [31:0] row, row_signed; // both before the inversion
    wire [31:0] row_next = step(row, {4'd0, sample});
    wire row_ends = valid && last;

    always @(posedge clk)
        if (anew || row_ends)
            row <= PRESET;
        else if (valid)
            row <= row_next;

    always @(posedge clk)
        if (row_ends)
            row_signed <= row_next;

    reg [31:0] frame;
    reg [5:0] place; // of the row's bit that goes into the frame's; 32 when all have
    wire feedback = frame[0] ^ !row_signed[place[4:0]];

    assign signed_all = place[5];
    assign signature = ~frame;
    assign row_signature = ~row_signed;

    always @(posedge clk)
        if (rst)
            place <= 6'd32;
        else if (row_ends)
            place <= 6'd0;
        else if (!place[5])
            place <= place + 6'd1;

    always @(posedge clk)
        if (rst || next_frame)
            frame <= PRESET;
        else if (!place[5])
            frame <= {1'b0, frame[31:1]} ^ (feedback ? POLYNOMIAL : 32'd0);
endmodule

`default_nettype wire
