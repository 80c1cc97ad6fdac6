// The check value, the residue, and drawn bytes against a register that takes one bit a time.
`default_nettype none

module halfrow_crc32_bench;
    reg  [31:0] crc;
    reg  [ 7:0] data;
    wire [31:0] next;
    integer     i, b, seed, faults;
    reg  [31:0] slow;
    reg  [71:0] digits;

    halfrow_crc32 dut (.crc(crc), .data(data), .next(next));

    task feed(input [7:0] value);
        begin
            data = value;
            #1 crc = next;
        end
    endtask

    initial begin
        faults = 0;
        seed   = 1;
        digits = "123456789";
        crc    = 32'hFFFFFFFF;
        for (i = 8; i >= 0; i = i - 1) feed(digits[8*i+:8]);
        if (~crc !== 32'hCBF43926) begin
            faults = faults + 1;
            $display("FAIL check value %h", ~crc);
        end
        slow = ~crc;
        for (i = 0; i < 4; i = i + 1) feed(slow[8*i+:8]);
        if (crc !== 32'hDEBB20E3) begin
            faults = faults + 1;
            $display("FAIL residue %h", crc);
        end
        for (i = 0; i < 10000; i = i + 1) begin
            crc  = $random(seed);
            data = $random(seed);
            slow = crc;
            for (b = 0; b < 8; b = b + 1) slow = {1'b0, slow[31:1]} ^ (slow[0] ^ data[b] ? 32'hEDB88320 : 32'd0);
            #1
            if (next !== slow) begin
                faults = faults + 1;
                $display("FAIL %h with %h: %h, not %h", crc, data, next, slow);
            end
        end
        if (faults == 0) $display("PASS check value, residue, 10000 drawn steps");
        $display("DONE");
        $finish;
    end
endmodule

`default_nettype wire
