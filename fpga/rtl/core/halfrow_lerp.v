// (2 ** STEPS - t) * x + t * y by one adder with a multiplexer in front, a bit of t a clock from the lowest on:
// x + the sum of 2 ** i * (t[i] ? y : x). What is final of the sum falls off its low end.
`default_nettype none

module halfrow_lerp #(
    parameter BITS = 25,
    parameter STEPS = 6,
    parameter ROUND = 0 // 1: and 2 ** (STEPS - 1)
) (
    input  wire                  clk,
    input  wire                  rst,
    input  wire                  start, // pulse; x and y stand still from then on for STEPS clocks
    input  wire [BITS-1:0]       x,
    input  wire [BITS-1:0]       y,
    input  wire [STEPS-1:0]      t,     // with start
    output wire                  done,  // pulse, STEPS clocks behind start
    output wire [BITS+STEPS-1:0] value  // from then on until the next start
);
    reg [BITS-1:0] high;
    reg [STEPS-1:0] low;
    reg [STEPS-2:0] rest; // of t
    reg [STEPS-1:0] steps; // bit i: so many clocks and one since start

    wire step = start || |steps[STEPS-2:0];
    wire round = (ROUND != 0) && steps[STEPS-2];
    wire takes_y = start ? t[0] : rest[0];
    wire [BITS+1:0] sum = {1'b0, start ? x : high, round} + {1'b0, takes_y ? y : x, round};

    always @(posedge clk)
        if (rst)
            steps <= {STEPS{1'b0}};
        else
            steps <= {steps[STEPS-2:0], start};

    always @(posedge clk) begin
        rest <= start ? t[STEPS-1:1] : {1'b0, rest[STEPS-2:1]};
        if (step)
            {high, low} <= {sum[BITS+1:1], low[STEPS-1:1]};
    end

    assign done = steps[STEPS-1];
    assign value = {high, low};
    wire unused = &{1'b0, sum[0]};
endmodule

`default_nettype wire
