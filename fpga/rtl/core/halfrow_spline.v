// A quadratic B-spline between three entries that come one a clock, (w0 * T0 + w1 * T1 + w2 * T2 + 2^12) >> 13,
// without a multiplier and without its weights: by de Boor's scheme it is (64 - t) * A + t * B of A =
// (64 - t) * T0 + (64 + t) * T1 and B = (128 - t) * T1 + t * T2. It may begin anew every eight clocks.
`default_nettype none

module halfrow_spline (
    input  wire        clk,
    input  wire        rst,
    input  wire [24:0] entry, // T0 and T1 with `shift`, T2 from start on for six clocks, the bits of t
    input  wire        shift,
    input  wire        start, // pulse, behind two of `shift`
    input  wire [5:0]  t,     // with start
    output wire        half,  // pulse, seven clocks behind start: A and B are there
    output wire        done,  // pulse, fourteen clocks behind start
    output wire [24:0] value  // from then on for two clocks
);
    reg [24:0] entry_0, entry_1;

    always @(posedge clk)
        if (shift)
            {entry_0, entry_1} <= {entry_1, entry};

    // The rounding, 2^12 of the whole, is 2^6 of either half.
    wire [31:0] a, b;
    wire half_b;
    halfrow_lerp #(.STEPS(7), .ROUND(1)) lerp_a (
        .clk(clk), .rst(rst), .start(start), .x(entry_0), .y(entry_1), .t({1'b1, t}), .done(half), .value(a));
    halfrow_lerp #(.STEPS(7), .ROUND(1)) lerp_b (
        .clk(clk), .rst(rst), .start(start), .x(entry_1), .y(entry), .t({1'b0, t}), .done(half_b), .value(b));

    reg [31:0] first, second; // A and B, whose registers are needed anew
    reg [5:0] t_first, t_second;
    reg go_on;
    wire [37:0] whole;

    always @(posedge clk) begin
        if (start)
            t_first <= t;
        if (half)
            {first, second, t_second} <= {a, b, t_first};
        go_on <= half && !rst;
    end

    halfrow_lerp #(.BITS(32)) lerp_ab (
        .clk(clk), .rst(rst), .start(go_on), .x(first), .y(second), .t(t_second), .done(done), .value(whole));
    assign value = whole[37:13];

    wire unused = &{1'b0, half_b, whole[12:0]};
endmodule

`default_nettype wire
