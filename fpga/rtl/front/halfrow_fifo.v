// A small queue in one clock: what goes in comes out, in order, a clock or more later.
`default_nettype none

module halfrow_fifo #(
    parameter WIDTH = 8,
    parameter BITS = 6 // holds 2 ** BITS - 1 words in its memory, and one at its output
) (
    input  wire             clk,
    input  wire             rst,

    input  wire             in_valid,
    input  wire [WIDTH-1:0] in_data,
    output wire             in_ready,

    output reg              out_valid,
    output reg  [WIDTH-1:0] out_data,
    input  wire             out_ready,

    output wire [BITS-1:0]  used // words in the memory
);
    generate // what a build cannot have
        if (WIDTH < 1) halfrow_illegal_WIDTH is_at_least_1 ();
        if (BITS < 1 || BITS > 16) halfrow_illegal_BITS is_1_to_16 ();
    endgenerate

    (* ram_style = "distributed" *) reg [WIDTH-1:0] words [0:(1<<BITS)-1];
    reg [BITS-1:0] head, tail;

    wire [BITS-1:0] behind_tail = tail + 1'b1;
    wire store = in_valid && in_ready;
    wire fetch = head != tail && (!out_valid || out_ready);

    assign in_ready = behind_tail != head;
    assign used = tail - head;

    always @(posedge clk) begin
        if (store) words[tail] <= in_data;
        if (fetch) out_data <= words[head];
    end

    always @(posedge clk) begin
        if (store) tail <= behind_tail;
        if (fetch) head <= head + 1'b1;
        if (!out_valid || out_ready) out_valid <= fetch;
        if (rst) begin
            head <= {BITS{1'b0}};
            tail <= {BITS{1'b0}};
            out_valid <= 1'b0;
        end
    end
endmodule

`default_nettype wire
