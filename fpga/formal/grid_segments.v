// halfrow_parabolas on rows of any three factors that differ by so many bits: at the second segment's first column S and D are what
// fpga/DATAPATH.md begins the segment with, S[0] + 2^(k+3) * (Q[0] + Q[1]) and 16Q + G, though neither is loaded there, and from there
// on D grows by 2G. The next slopes are asked for with a segment's last column but one.
`default_nettype none

module grid_segments #(
    parameter K = 5, // segments of 2^K columns, 5 or 6
    parameter BITS = 4, // of a factor that are any, above the lowest three; the others are FACTOR's
    parameter FACTOR = 25'd14680064
) (
    input wire            clk,
    input wire [BITS-1:0] any_0,
    input wire [BITS-1:0] any_1,
    input wire [BITS-1:0] any_2
);
    reg running = 1'b0;
    always @(posedge clk) running <= 1'b1;
    wire row_begin = !begun_once;

    // The row is one and begins once; what is drawn at its beginning stays.
    reg begun_once = 1'b0;
    reg [6:0] begun = 7'd0; // columns, with the present one
    reg [24:0] q0, q1, q2;
    wire [36:0] position = 37'h1234567; // S[0] / 8 + 2^11: it is only added
    wire [24:0] new_0 = FACTOR + {any_0, 3'd0}, new_1 = FACTOR + {any_1, 3'd0}, new_2 = FACTOR + {any_2, 3'd0};

    // G is the difference of factors by 2^(k-3).
    wire [25:0] rise_0 = {1'b0, new_1} - {1'b0, new_0}, rise_1 = {1'b0, q2} - {1'b0, q1};
    wire [25:0] rise = {1'b0, q2} - {1'b0, q0};
    wire [23:0] slope_0 = {{K-5{rise_0[25]}}, rise_0[25:K-3]}, slope_1 = {{K-5{rise_1[25]}}, rise_1[25:K-3]};
    wire ask_next;
    wire [39:0] sum;
    wire [28:0] step;

    halfrow_parabolas dut (
        .clk(clk), .enable(1'b1), .row_begin(row_begin), .position(position), .factor(new_0), .has_grid(1'b1),
        .long_segments(K == 6), .first_slope(slope_0), .next_slope(slope_1), .hand_over({{K-5{rise[25]}}, rise[25:K-3]}),
        .reading(begun_once), .begun(begun[5:0]), .ask_next(ask_next), .\sum (sum), .\step (step));

    always @(posedge clk) begin
        begun_once <= 1'b1;
        begun <= begun + 7'd1;
        if (row_begin)
            {q0, q1, q2} <= {new_0, new_1, new_2};
    end

    wire [39:0] second = {position, 3'd0} + ({14'd0, {1'b0, q0} + {1'b0, q1}} << K + 3);
    wire [28:0] next_step = {q1, 4'd0} + {{5{slope_1[23]}}, slope_1};

    always @(posedge clk)
        if (running) begin
            if (begun == (1 << K) + 1) assert (sum == second && step == next_step);
            if (begun == (1 << K) + 2) assert (step == next_step + {{4{slope_1[23]}}, slope_1, 1'b0});
            assert (ask_next == (begun == (1 << K) - 1 || begun == 7'd63));
        end
endmodule

`default_nettype wire
