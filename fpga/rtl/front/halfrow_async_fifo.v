// A small queue from one clock into another. Pointers cross in Gray code, through two registers. Both sides must be
// in reset together for a few clocks of the slower one.
`default_nettype none

module halfrow_async_fifo #(
    parameter WIDTH = 8,
    parameter BITS = 5 // holds 2 ** BITS words in its memory, and one at its output
) (
    input  wire             in_clk,
    input  wire             in_rst,
    input  wire             in_valid,
    input  wire [WIDTH-1:0] in_data,
    output wire             in_ready,

    input  wire             out_clk,
    input  wire             out_rst,
    output reg              out_valid,
    output reg  [WIDTH-1:0] out_data,
    input  wire             out_ready
);
    generate // what a build cannot have
        if (WIDTH < 1) halfrow_illegal_WIDTH is_at_least_1 ();
        if (BITS < 2 || BITS > 16) halfrow_illegal_BITS is_2_to_16 ();
    endgenerate

    (* ram_style = "distributed" *) reg [WIDTH-1:0] words [0:(1<<BITS)-1];

    // The pointers have one bit more than an address, so that a full memory differs from an empty one.
    reg [BITS:0] tail, tail_gray;
    reg [BITS:0] head, head_gray;
    (* ASYNC_REG = "TRUE" *) reg [BITS:0] head_near_in, head_in;
    (* ASYNC_REG = "TRUE" *) reg [BITS:0] tail_near_out, tail_out;

    wire [BITS:0] tail_next = tail + 1'b1;
    wire [BITS:0] head_next = head + 1'b1;
    wire store = in_valid && in_ready;
    wire fetch = head_gray != tail_out && (!out_valid || out_ready);

    assign in_ready = tail_gray != {~head_in[BITS:BITS-1], head_in[BITS-2:0]};

    always @(posedge in_clk) begin
        if (store) words[tail[BITS-1:0]] <= in_data;
    end

    always @(posedge in_clk) begin
        {head_in, head_near_in} <= {head_near_in, head_gray};
        if (store) begin
            tail <= tail_next;
            tail_gray <= tail_next ^ (tail_next >> 1);
        end
        if (in_rst) begin
            tail <= {BITS + 1{1'b0}};
            tail_gray <= {BITS + 1{1'b0}};
            head_near_in <= {BITS + 1{1'b0}};
            head_in <= {BITS + 1{1'b0}};
        end
    end

    always @(posedge out_clk) begin
        if (fetch) out_data <= words[head[BITS-1:0]];
    end

    always @(posedge out_clk) begin
        {tail_out, tail_near_out} <= {tail_near_out, tail_gray};
        if (!out_valid || out_ready) out_valid <= fetch;
        if (fetch) begin
            head <= head_next;
            head_gray <= head_next ^ (head_next >> 1);
        end
        if (out_rst) begin
            out_valid <= 1'b0;
            head <= {BITS + 1{1'b0}};
            head_gray <= {BITS + 1{1'b0}};
            tail_near_out <= {BITS + 1{1'b0}};
            tail_out <= {BITS + 1{1'b0}};
        end
    end
endmodule

`default_nettype wire
