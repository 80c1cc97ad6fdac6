// How many entries a grid of a shape has, (N + 2) * Z of fpga/DATAPATH.md: a shift a clock for Z, then a bit of N + 2 a
// clock.
`default_nettype none

module halfrow_grid_size (
    input  wire        clk,
    input  wire        start,         // pulse; what stands below is stable until done
    input  wire [2:0]  v,
    input  wire        long_segments, // k is 6, not 5
    input  wire [11:0] width,
    input  wire [11:0] height,
    output wire        done,          // at most 15 clocks behind start, until the next one
    output reg  [17:0] entries
);
    localparam [3:0] BITS = 4'd8; // the first of them is 0, while rows are added up

    reg [2:0] shifts;
    reg [3:0] bits;
    reg [10:0] quotient; // of H - 1
    reg [10:0] rows;     // Z
    reg [7:0] columns;   // N + 2
    wire [6:0] whole = long_segments ? {1'b0, width[11:6]} : width[11:5];
    wire more = long_segments ? width[5:0] != 6'd0 : width[4:0] != 5'd0;

    assign done = bits == 4'd0;

    always @(posedge clk) begin
        rows <= quotient + 11'd3;
        if (start) begin
            shifts <= v;
            bits <= BITS;
            quotient <= height[10:0] - 11'd1;
            columns <= {1'b0, whole} + {6'd0, 1'b1, more};
            entries <= 18'd0;
        end else if (shifts != 3'd0) begin
            shifts <= shifts - 3'd1;
            quotient <= {1'b0, quotient[10:1]};
        end else if (bits != 4'd0) begin
            bits <= bits - 4'd1;
            columns <= {columns[6:0], 1'b0};
            entries <= {entries[16:0], 1'b0} + {7'd0, rows & {11{columns[7]}}};
        end
    end

    wire unused = &{1'b0, height[11]};
endmodule

`default_nettype wire
