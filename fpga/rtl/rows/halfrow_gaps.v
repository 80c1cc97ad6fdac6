// The generator of gaps, xorshift32, which the seed 0 turns off.
`default_nettype none

module halfrow_gaps (
    input  wire        clk,
    input  wire        rst,
    input  wire [31:0] seed,
    input  wire        restart, // sets the generator to the seed
    input  wire        draw,    // goes on to the next value
    output wire [3:0]  drawn,   // low bits of the newest
    output reg         on       // there are gaps
);
    reg [31:0] x;
    // Kept, because the mapper would trade look-up tables for depth.
    (* keep = "true" *) wire [31:0] a;
    assign a = x ^ {x[18:0], 13'd0};
    wire [31:0] b = a ^ {17'd0, a[31:17]};
    wire [31:0] c = b ^ {b[26:0], 5'd0};

    assign drawn = x[3:0];

    always @(posedge clk)
        if (restart)
            x <= seed;
        else if (draw)
            x <= c;

    always @(posedge clk)
        if (rst)
            on <= 1'b0;
        else if (restart)
            on <= seed != 32'd0;
endmodule

`default_nettype wire
