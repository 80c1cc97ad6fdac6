// The frozen packets of protocol/vectors, given to the dispatcher and compared with what it replies; behind dispatcher_harness.vh.

reg [7:0] vector [0:4200]; // a decoded packet
integer   vector_total;

// Reads protocol/vectors/NAME.hex and undoes its stuffing.
task load_vector(input [8*40-1:0] name);
    reg [8*80-1:0] path;
    integer file, c, digits, value, left, full;
    begin
        $swrite(path, "protocol/vectors/%0s.hex", name);
        file         = $fopen(path, "r");
        vector_total = 0;
        digits       = 0;
        value        = 0;
        left         = 0;
        full         = 1;
        c            = $fgetc(file);
        while (c >= 0) begin
            if (c == "/") while (c >= 0 && c != "\n") c = $fgetc(file);
            else if (c > " ") begin
                value  = value * 16 + (c <= "9" ? c - "0" : c - "a" + 10);
                digits = digits + 1;
            end
            if (digits == 2) begin
                if (value == 0) begin
                    left = 0;
                    full = 1;
                end
                else if (left == 0) begin
                    if (!full) begin
                        vector[vector_total] = 0;
                        vector_total         = vector_total + 1;
                    end
                    left = value - 1;
                    full = value == 255;
                end else begin
                    vector[vector_total] = value;
                    vector_total         = vector_total + 1;
                    left                 = left - 1;
                end
                {digits, value} = 0;
            end
            c = $fgetc(file);
        end
        $fclose(file);
    end
endtask

task give_vector(input [8*40-1:0] name);
    begin
        load_vector(name);
        for (i = 12; i < vector_total - 4; i = i + 1) payload[i-12] = vector[i];
        packet_sequence = {vector[3], vector[2]} - 16'd257;
        give(vector[1], vector_total - 16, vector[7]);
    end
endtask

// The reply that came is this vector's.
task like_vector(input [8*40-1:0] name);
    begin
        load_vector(name);
        check(got_kind === vector[1] && got_session === vector[7] && got_sequence === {vector[3], vector[2]}, "the vector's header");
        check(got_total == vector_total - 16, "the vector's length");
        for (i = 12; i < vector_total - 4; i = i + 1) check(got[i-12] === vector[i], "the vector's payload");
    end
endtask
