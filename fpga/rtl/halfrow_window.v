// The samples around the source column n, and the taps among them. The newest is the ring's own output.
`default_nettype none

module halfrow_window #(
    parameter SPAN = 3                       // the window is n - SPAN ... n + SPAN + 1
) (
    input  wire                     clk,
    input  wire                     enable,
    input  wire                     load,
    input  wire [12*(2*SPAN+1)-1:0] opening, // n - SPAN ... n + SPAN of a row's first output
    input  wire [11:0]              newest,
    input  wire                     other_colour,
    output wire [12*7-1:0]          taps     // G0 R1 G2 R3 G4 R5 G6, G0 lowest; with five taps G0 and G6 are 0
);
    localparam SLOTS = 2 * SPAN + 1;
    localparam FIRST = 3 - SPAN;             // the first tap that there is

    reg  [12*SLOTS-1:0]     kept;
    wire [12*(SLOTS+1)-1:0] window = {newest, kept};

    always @(posedge clk)
        if (enable)
            kept <= load ? opening : window[12*(SLOTS+1)-1:12];

    wire [12*SLOTS-1:0] chosen = other_colour ? window[12*SLOTS-1:0] : window[12*(SLOTS+1)-1:12];
    assign taps = {{12*FIRST{1'b0}}, chosen, {12*FIRST{1'b0}}};
endmodule

`default_nettype wire
