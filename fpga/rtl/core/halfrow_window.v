// The samples around the source column n, and the taps among them. The newest is the ring's own output.
`default_nettype none

module halfrow_window #(
    parameter LEFT = 3 // the window is n - LEFT ... n + 4; five taps need 2, seven 3
) (
    input  wire                   clk,
    input  wire                   enable,
    input  wire                   load,
    input  wire [12*(LEFT+4)-1:0] opening, // n - LEFT ... n + 3 of a row's first output
    input  wire [11:0]            newest,
    input  wire                   other_colour,
    output wire [12*7-1:0]        taps     // G0 R1 G2 R3 G4 R5 G6, G0 lowest; with five taps G0 and G6 are 0
);
    localparam SLOTS = LEFT + 4;
    localparam TAPS = 2 * LEFT + 1;

    // With five taps the newest sample is no tap yet. Both builds read a sample on the same clock, the first on which
    // it is sure to have come and the last on which the ring is sure to hold it.
    reg [12*SLOTS-1:0] kept;
    wire [12*(SLOTS+1)-1:0] window = {newest, kept};

    always @(posedge clk)
        if (enable)
            kept <= load ? opening : window[12*(SLOTS+1)-1:12];

    wire [12*TAPS-1:0] chosen = other_colour ? window[12*TAPS-1:0] : window[12*(TAPS+1)-1:12];
    generate
        if (LEFT == 3) begin : outer
            assign taps = chosen;
        end else begin : inner
            assign taps = {12'd0, chosen, 12'd0};
        end
    endgenerate
endmodule

`default_nettype wire
