// The generator of gaps, xorshift32, which the seed 0 turns off. A burst's samples come of its draws instead.
`default_nettype none

module halfrow_gaps (
    input  wire        clk,
    input  wire        rst,
    input  wire        burst,   // the next restart is a burst's: there are no gaps
    input  wire [31:0] seed,
    input  wire        restart, // sets the generator to the seed
    input  wire        draw,    // goes on to the next value
    output wire [3:0]  drawn,   // low bits of the newest
    output wire [31:0] next,    // the value behind it
    output reg         on       // there are gaps
);
    reg [31:0] x;

    halfrow_xorshift xorshift (.x(x), .next(next));

    assign drawn = x[3:0];

    always @(posedge clk)
        if (restart)
            x <= seed;
        else if (draw)
            x <= next;

    always @(posedge clk)
        if (rst)
            on <= 1'b0;
        else if (restart)
            on <= seed != 32'd0 && !burst;
endmodule

`default_nettype wire
